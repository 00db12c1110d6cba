"""Figure 10: two Q tables at full control."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, ORDERED_BY_UPRIGHT
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

CELL = "full-control/modular-table/alpha-0.001"
TABLE = "full-control/table/alpha-0.001"
FIGURE = Declaration(
    "Modular Q tables at full control, α = 0.001", "§4.6.3", ("C11",), (CELL, TABLE), number=10
)


def draw(results: "Results") -> "Drawing":
    """The angle, and the upright share of all runs beside that of one table."""
    from upswing.figures import panels
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    rows = [Row(CELL, "two tables, α = 0.001")]
    figure, runs = three_and_all(results, rows, [(TABLE, "one table")])
    caption = (
        "Modular Q-learning with two tables of 4 × 20 tiles at full control, α = 0.001. Left: "
        f"{ANGLE_HISTOGRAM}. {ORDERED_BY_UPRIGHT}. Right: the share of upright steps of all "
        f"{len(results.cell(CELL))} runs; {ENSEMBLE}, the dashed line the median of one table "
        f"(figure 8). {frequency(results, CELL)}"
    )
    return panels.Drawing(figure, caption, runs)
