"""Figure 9: networks at full control, in three sizes."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, ORDERED_BY_UPRIGHT
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

CELLS = {
    "full-control/networks-30/alpha-1": "160-30-1",
    "full-control/networks-20-5/alpha-1": "160-20-5-1",
    "full-control/networks-5/alpha-1": "160-5-1",
}
FIGURE = Declaration("Networks at full control, α = 1", "§4.6.2", ("C10",), tuple(CELLS), number=9)


def draw(results: "Results") -> "Drawing":
    """The angle and the upright share for each size; the thesis shows the first."""
    from upswing.figures import panels
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    figure, runs = three_and_all(results, [Row(cell, label) for cell, label in CELLS.items()])
    first = next(iter(CELLS))
    caption = (
        "Q-learning with three networks at full control, α = 1, in the three sizes of the thesis, "
        f"which shows the first. Left: {ANGLE_HISTOGRAM}. {ORDERED_BY_UPRIGHT}. Right: the share of "
        f"upright steps of all {len(results.cell(first))} runs; {ENSEMBLE}. A dark bar near ±135° is "
        "a cart that is pushed one way for ever, which holds the rod there. Of the first size, "
        f"{frequency(results, first)}"
    )
    return panels.Drawing(figure, caption, runs)
