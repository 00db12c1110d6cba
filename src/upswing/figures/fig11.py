"""Figure 11: modular networks at full control."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, ORDERED_BY_UPRIGHT
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

CELL = "full-control/modular-networks-5/alpha-1"
SINGLE = "full-control/networks-5/alpha-1"
FIGURE = Declaration(
    "Modular networks at full control, α = 1",
    "§4.6.3",
    ("C12", "C13", "C14", "C15"),
    (CELL, SINGLE),
    number=11,
)


def draw(results: "Results") -> "Drawing":
    """The angle, and the upright share of all runs beside that of networks without modules."""
    from upswing.figures import panels
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    rows = [Row(CELL, "modular, α = 1")]
    figure, runs = three_and_all(results, rows, [(SINGLE, "single")])
    caption = (
        "Modular Q-learning with two times three networks of 80-5-1 neurons at full control, "
        f"α = 1. Left: {ANGLE_HISTOGRAM}. {ORDERED_BY_UPRIGHT}. Right: the share of upright steps of "
        f"all {len(results.cell(CELL))} runs; {ENSEMBLE}, the dashed line the median of networks of the "
        "same size without modules (figure 9). What to see: some runs get up and stand, most do not. "
        f"{frequency(results, CELL)}"
    )
    return panels.Drawing(figure, caption, runs)
