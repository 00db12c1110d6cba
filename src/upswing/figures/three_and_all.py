"""Rows of a figure: the worst, median and best run of a cell, and beside them all of its runs."""

from collections.abc import Sequence
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from upswing.figures import panels
from upswing.figures.style import stacks_and_panels
from upswing.runs.results import OneRun, Results
from upswing.runs.success import succeeds

RANKS = ("worst", "median", "best")
ENDS = {
    ("falls", True): "balances to the end",
    ("falls", False): "still falls in its last fifth",
    ("upright", True): "stands at the end",
    ("upright", False): "does not stand at the end",
}


class Row(NamedTuple):
    """What a row shows."""

    cell: str
    label: str
    steps: int | None = None  # the first steps only


def three_and_all(
    results: Results, rows: Sequence[Row], beside: Sequence[tuple[str, str]] = ()
) -> tuple[Figure, list[str]]:
    """A figure of ``rows``, and the runs that it shows.

    Balancing shows an angle as a line, full control where the pendulum was.

    Args:
        results: what is drawn.
        rows: the cells, from top to bottom.
        beside: ids and labels of cells whose medians are drawn beside the runs, for comparison.
    """
    figure, grid = stacks_and_panels(len(rows), len(RANKS))
    shown: dict[str, None] = {}
    compared = [(cell, label, results.ensemble(cell)) for cell, label in beside]
    for row, (stack, right) in zip(rows, grid, strict=True):
        shown |= dict.fromkeys(run.id for run in _stack(results, row, stack))
        alike = [(row.cell, row.label, results.ensemble(row.cell)), *compared]
        if results.task(row.cell).judged_by == "falls":
            panels.falls(right, alike, row.steps)
        else:
            panels.upright(right, alike)
        first = f", first {row.steps:,} steps" if row.steps else ""
        right.set_title(f"{row.label}{first}: all runs")
    return figure, list(shown)


def _stack(results: Results, row: Row, stack: Sequence[Axes]) -> list[OneRun]:
    """The three runs of a cell, the worst above."""
    task = results.task(row.cell)
    succeeded = succeeds(results.three_of(row.cell), task)
    runs = results.worst_median_best(row.cell)
    for axes, rank, run, well in zip(stack, RANKS, runs, succeeded, strict=True):
        if task.judged_by == "falls":
            panels.angle(axes, run, row.cell, row.steps)
        else:
            panels.angle_histogram(axes, run, row.cell)
        middle = axes is stack[1]
        axes.set(ylabel="angle φ [°]" if middle else "")
        limit = task.angle_limit
        axes.set_yticks((-limit, 0, limit))
        words = f"{rank} (seed {run.seed}): {ENDS[task.judged_by, bool(well)]}"
        axes.set_title(words, loc="left", pad=2)
        if axes is not stack[-1]:
            axes.tick_params(labelbottom=False)
            axes.set_xlabel("")
    return runs
