"""Rows of a figure: the worst, median and best run of a cell, and beside them all of its runs."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from upswing.figures import decisive, panels
from upswing.figures.appearance import SMALL
from upswing.figures.decided import Decided, decided
from upswing.figures.phases import WORDS
from upswing.figures.style import LOW, stacks_and_panels
from upswing.runs.results import OneRun, Results
from upswing.runs.success import succeeds
from upswing.study.claims import Claim
from upswing.study.physical import PendulumOptions

WHOLE_TURN = 0.95
"""Height of a low panel that shows a whole turn, with its title [inch]."""

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


class Shown(NamedTuple):
    """A figure of such rows, and what its words are made of."""

    figure: Figure
    runs: list[str]  # those that are shown alone
    phases: list[str]  # named on the picture, in the order of ``phases.WORDS``
    decided: list[Decided]
    lacking: list[str]  # claims of which the study has not all cells
    steps: dict[str, int]  # of the runs of each cell
    bodies: list[PendulumOptions]  # of the rows

    def part(self, claim: str, number: int = 1) -> Decided | None:
        """A part of a claim, if the study has it."""
        own = [one for one in self.decided if one.claim == claim]
        return next((one for one in own if one.evidence[0].part == number), None)


def three_and_all(
    results: Results,
    rows: Sequence[Row],
    claims: Mapping[str, Claim],
    beside: Sequence[tuple[str, str]] = (),
    others: Sequence[str] = (),
) -> Shown:
    """A figure of ``rows``, and below them what decides the claims.

    Balancing shows an angle as a line, full control where the pendulum was.

    Args:
        results: what is drawn.
        rows: the cells, from top to bottom.
        claims: those that the figure shows.
        beside: ids and labels of cells whose medians are drawn beside the runs, for comparison.
        others: cells that are shown beside what decides, where the study has them.
    """
    found, lacking = decided(results, claims, others)
    by_falls = results.task(rows[0].cell).judged_by == "falls"
    figure, grid, below = stacks_and_panels(
        len(rows), len(RANKS), LOW if by_falls else WHOLE_TURN, decisive.height(found)
    )
    shown: dict[str, None] = {}
    named: set[str] = set()
    compared = [(cell, label, results.ensemble(cell)) for cell, label in beside]
    for row, (stack, right) in zip(rows, grid, strict=True):
        runs, phases = _stack(results, row, stack)
        shown |= dict.fromkeys(run.id for run in runs)
        named |= phases
        alike = [(row.cell, row.label, results.ensemble(row.cell)), *compared]
        if by_falls:
            panels.falls(right, alike, row.steps)
        else:
            panels.upright(right, alike)
        first = f", first {row.steps:,} steps" if row.steps else ""
        right.set_title(f"{row.label}{first}: all runs")
    steps = {cell: spec.task.steps for cell, spec in results.cells.items()}
    if below is not None:
        decisive.draw(figure, below, found, results)
    bodies = [results.task(row.cell).pendulum for row in rows]
    names = [name for name in WORDS if name in named]
    return Shown(figure, list(shown), names, found, lacking, steps, bodies)


def _stack(results: Results, row: Row, stack: Sequence[Axes]) -> tuple[list[OneRun], set[str]]:
    """The three runs of a cell, the worst above, and the phases that are named."""
    task = results.task(row.cell)
    succeeded = succeeds(results.three_of(row.cell), task)
    runs = results.worst_median_best(row.cell)
    named: set[str] = set()
    for axes, rank, run, well in zip(stack, RANKS, runs, succeeded, strict=True):
        if task.judged_by == "falls":
            panels.angle(axes, run, row.cell, row.steps)
        else:
            named |= {phase.name for phase in panels.angle_histogram(axes, run, row.cell)}
        axes.set(ylabel="angle φ" if axes is stack[1] else "")
        if task.judged_by == "falls":
            axes.set_yticks((-task.angle_limit, 0, task.angle_limit))
        axes.tick_params(axis="y", labelsize=SMALL)
        words = f"{rank} (seed {run.seed}): {ENDS[task.judged_by, bool(well)]}"
        axes.set_title(words, loc="left", pad=2, fontsize=SMALL + 0.5)
        if axes is not stack[-1]:
            axes.tick_params(labelbottom=False)
            axes.set_xlabel("")
    return runs, named
