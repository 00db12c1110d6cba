"""The cells of a study."""

from upswing.cli.terminal import print_table, say
from upswing.study.matrix import Matrix


def print_matrix(matrix: Matrix) -> None:
    """Print a row for each cell, and what all of them come to."""
    rows = [
        (name, f"{len(cell.seeds):,}", f"{cell.task.steps:,}")
        for name, cell in matrix.cells.items()
    ]
    print_table(("cell", "runs", "steps a run"), rows, right=("runs", "steps a run"))
    steps = sum(cell.task.steps * len(cell.seeds) for cell in matrix.cells.values())
    say(f"{len(matrix.cells)} cells, {len(list(matrix.runs))} runs, {steps:,} steps")
