"""Figure 5: a Q table balances, with α = 1."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ENSEMBLE, ORDERED_BY_FALLS
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from collections.abc import Mapping

    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results
    from upswing.study.claims import Claim

CELL = "balancing/table/alpha-1"
FIGURE = Declaration(
    "A Q table in the balancing task, α = 1", "§4.5.1", ("C1", "C2"), (CELL,), number=5
)


def draw(results: "Results", claims: "Mapping[str, Claim]") -> "Drawing":
    """The angle over 5,000 and 50,000 steps, and the falls of all runs."""
    from upswing.figures import panels, told
    from upswing.figures.captions import what_decides
    from upswing.figures.lengths import grid_of
    from upswing.figures.success_share import share
    from upswing.figures.three_and_all import Row, three_and_all

    shown = three_and_all(
        results, [Row(CELL, "table, α = 1", 5_000), Row(CELL, "table, α = 1")], claims
    )
    found = share(results, CELL)
    at_first = results.counted(CELL)["falls_first_5000"].sub(
        results.counted(CELL)["falls_2500_to_5000"]
    )
    later, last = (
        told.times(told.middle(results, CELL, name))
        for name in ("falls_2500_to_5000", "falls_last_fifth")
    )
    still = f"{found.of - found.successes} of {found.of} tables still fall in their last fifth"
    task = results.task(CELL)
    fifth, half = task.steps // 5, f"{task.steps_of(2_500):,}"
    caption = (
        f"Q-learning with a table of {grid_of(results.cells[CELL])} tiles in the balancing task, α = 1: "
        f"the first 5,000 steps above, the whole run below. Left: the angle. {ORDERED_BY_FALLS}. "
        f"Right: falls of all {len(results.cell(CELL))} runs; {ENSEMBLE}. What to see: in the median, a "
        f"table falls {told.times(at_first.median())} in the first {half} steps, {later} in the "
        f"next {half}, and {last} in the last {fifth:,}; {still}.{what_decides(shown)}"
    )
    alt = f"{still}, in the median {last}."
    return panels.Drawing(shown.figure, caption, shown.runs, alt)
