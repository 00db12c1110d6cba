"""Figure 9: networks at full control, in three sizes."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, MEDIAN_BY_UPRIGHT
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

    figure, runs = panels.one_and_all(results, list(CELLS.items()))
    count = len(results.cell(next(iter(CELLS))))
    caption = (
        "Q-learning with three networks at full control, α = 1, in the three sizes of the thesis, "
        f"which shows the first. Left: {ANGLE_HISTOGRAM}. {MEDIAN_BY_UPRIGHT}. Right: the share of "
        f"upright steps of all {count} runs; {ENSEMBLE}. "
        f"Of the first, {frequency(results, next(iter(CELLS)))}"
    )
    return panels.Drawing(figure, caption, [run.id for run in runs])
