"""Figure 7: networks balance."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ENSEMBLE, ORDERED_BY_FALLS
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

CELL = "balancing/networks-5/alpha-1"
TABLE = "balancing/table/alpha-1"
FIGURE = Declaration(
    "Networks in the balancing task, α = 1", "§4.5.2", ("C4", "C5", "C6"), (CELL, TABLE), number=7
)


def draw(results: "Results") -> "Drawing":
    """The angle over 5,000 and 50,000 steps, and the falls of all runs beside the table's."""
    from upswing.figures import panels
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    rows = [Row(CELL, "networks, α = 1", 5_000), Row(CELL, "networks, α = 1")]
    figure, runs = three_and_all(results, rows, [(TABLE, "table")])
    caption = (
        "Q-learning with three networks of 80-5-1 neurons in the balancing task, α = 1: the first "
        f"5,000 steps above, the whole run below. Left: the angle. {ORDERED_BY_FALLS}. Right: falls "
        f"of all {len(results.cell(CELL))} runs; {ENSEMBLE}, the dashed line the median of the table "
        "with α = 1 (figure 5). What to see: networks fall more often at first; those that learn it "
        f"then hardly fall again, and some never learn it. {frequency(results, CELL)}"
    )
    return panels.Drawing(figure, caption, runs)
