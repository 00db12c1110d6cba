"""Figure 8: a Q table at full control."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, ORDERED_BY_UPRIGHT
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

CELL = "full-control/table/alpha-0.001"
CONTROLS = {
    "full-control/idle/alpha-none": "no control",
    "full-control/random/alpha-none": "random",
}
FIGURE = Declaration(
    "A Q table at full control, α = 0.001",
    "§4.6.1",
    ("C7", "C8", "C9"),
    (CELL, *CONTROLS),
    number=8,
)


def draw(results: "Results") -> "Drawing":
    """The angle, and the upright share of all runs beside that of the controls."""
    from upswing.figures import panels
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    figure, runs = three_and_all(results, [Row(CELL, "table, α = 0.001")], list(CONTROLS.items()))
    caption = (
        "Q-learning with a table of 8 × 20 tiles at full control, α = 0.001. Left: "
        f"{ANGLE_HISTOGRAM}. {ORDERED_BY_UPRIGHT}. Right: the share of upright steps of all "
        f"{len(results.cell(CELL))} runs; {ENSEMBLE}, dashed lines the medians of no control and of "
        "random actions. A dark bar near ±135° is a cart that is pushed one way for ever, which holds "
        f"the rod there. {frequency(results, CELL)}"
    )
    return panels.Drawing(figure, caption, runs)
