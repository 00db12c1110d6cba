"""Figure 11: modular networks at full control."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, ORDERED_BY_UPRIGHT
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from collections.abc import Mapping

    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results
    from upswing.study.claims import Claim

CELL = "full-control/modular-networks-5/alpha-1"
SINGLE = "full-control/networks-5/alpha-1"
FIGURE = Declaration(
    "Modular networks at full control, α = 1",
    "§4.6.3",
    ("C12", "C13", "C14", "C15"),
    (CELL, SINGLE),
    number=11,
)


def draw(results: "Results", claims: "Mapping[str, Claim]") -> "Drawing":
    """The angle, and the upright share of all runs beside that of networks without modules."""
    from upswing.figures import panels, told
    from upswing.figures.captions import phases_named, what_decides
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    rows = [Row(CELL, "modular")]
    shown = three_and_all(results, rows, claims, [(SINGLE, "single")])
    up = next((one for one in shown.decided if "recovered_share" in one.part.where), None)
    come_up = told.of_a_part(up)
    rise = (
        f" Of the modular ones that do not, {come_up} come up from most of their falls."
        if come_up
        else ""
    )
    stand = f"{frequency(results, CELL)} Without modules, {told.counted(results, SINGLE)} do."
    caption = (
        "Modular Q-learning with two times three networks of 80-5-1 neurons at full control, "
        f"α = 1. Left: {ANGLE_HISTOGRAM}. {ORDERED_BY_UPRIGHT}.{phases_named(shown)} Right: the share "
        f"of upright steps of all {len(results.cell(CELL))} runs; {ENSEMBLE}, the dashed line the "
        "median of networks of the same size without modules (figure 9). What to see: "
        f"{stand}{rise}{what_decides(shown)}"
    )
    return panels.Drawing(shown.figure, caption, shown.runs, f"{stand}{rise}")
