"""Figure 10: two Q tables at full control."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, ORDERED_BY_UPRIGHT
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from collections.abc import Mapping

    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results
    from upswing.study.claims import Claim

CELL = "full-control/modular-table/alpha-0.001"
TABLE = "full-control/table/alpha-0.001"
FIGURE = Declaration(
    "Modular Q tables at full control, α = 0.001", "§4.6.3", ("C11",), (CELL, TABLE), number=10
)


def draw(results: "Results", claims: "Mapping[str, Claim]") -> "Drawing":
    """The angle, and the upright share of all runs beside that of one table."""
    from upswing.figures import panels, told
    from upswing.figures.captions import phases_named, what_decides
    from upswing.figures.lengths import grid_of
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    rows = [Row(CELL, "two tables")]
    shown = three_and_all(results, rows, claims, [(TABLE, "one table")])
    alike = next((one for one in shown.decided if one.part.kind == "share_identical"), None)
    both = told.of_a_part(alike)
    same = f" {both} runs are, step for step, the run of one table with their seed." if both else ""
    one = told.counted(results, TABLE)
    stand = f"with two tables, {frequency(results, CELL)} With one table, {one} do."
    caption = (
        f"Modular Q-learning with two tables of {grid_of(results.cells[CELL])} tiles at full control, "
        f"α = 0.001. Left: {ANGLE_HISTOGRAM}. {ORDERED_BY_UPRIGHT}.{phases_named(shown)} Right: "
        f"the share of upright steps of all {len(results.cell(CELL))} runs; {ENSEMBLE}, the dashed line "
        f"the median of one table (figure 8). What to see: {stand}{same}{what_decides(shown)}"
    )
    alt = f"{stand[0].upper()}{stand[1:]}{same}"
    return panels.Drawing(shown.figure, caption, shown.runs, alt)
