"""Figure 5: a Q table balances, with α = 1."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ENSEMBLE, ORDERED_BY_FALLS
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

CELL = "balancing/table/alpha-1"
FIGURE = Declaration(
    "A Q table in the balancing task, α = 1", "§4.5.1", ("C1", "C2"), (CELL,), number=5
)


def draw(results: "Results") -> "Drawing":
    """The angle over 5,000 and 50,000 steps, and the falls of all runs."""
    from upswing.figures import panels
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    rows = [Row(CELL, "table, α = 1", 5_000), Row(CELL, "table, α = 1")]
    figure, runs = three_and_all(results, rows)
    caption = (
        "Q-learning with a table of 4 × 20 tiles in the balancing task, α = 1: the first 5,000 "
        f"steps above, the whole run below. Left: the angle. {ORDERED_BY_FALLS}. Right: falls of "
        f"all {len(results.cell(CELL))} runs; {ENSEMBLE}. What to see: it soon falls less often, and "
        f"never stops falling. {frequency(results, CELL)}"
    )
    return panels.Drawing(figure, caption, runs)
