"""Figure 9: networks at full control, in three sizes."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, ORDERED_BY_UPRIGHT
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from collections.abc import Mapping

    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results
    from upswing.study.claims import Claim

CELLS = {
    "full-control/networks-30/alpha-1": "160-30-1",
    "full-control/networks-20-5/alpha-1": "160-20-5-1",
    "full-control/networks-5/alpha-1": "160-5-1",
}
FIGURE = Declaration("Networks at full control, α = 1", "§4.6.2", ("C10",), tuple(CELLS), number=9)


def draw(results: "Results", claims: "Mapping[str, Claim]") -> "Drawing":
    """The angle and the upright share for each size; the thesis shows the first."""
    from upswing.figures import panels, told
    from upswing.figures.captions import phases_named, what_decides
    from upswing.figures.three_and_all import Row, three_and_all

    shown = three_and_all(results, [Row(cell, label) for cell, label in CELLS.items()], claims)
    sizes = sorted({len(results.cell(cell)) for cell in CELLS})
    upright = [told.per_cent(told.middle(results, cell, "upright_share")) for cell in CELLS]
    stand = f"uns that stand at the end: {told.one_by_one(results, CELLS)}"
    median = f"the median run is upright for {', '.join(upright)} of its last fifth, in this order"
    caption = (
        "Q-learning with three networks at full control, α = 1, in the three sizes of the thesis, "
        f"which shows the first. Left: {ANGLE_HISTOGRAM}. {ORDERED_BY_UPRIGHT}.{phases_named(shown)} "
        f"Right: the share of upright steps of all {' or '.join(map(str, sizes))} runs; {ENSEMBLE}. "
        f"What to see: r{stand}; {median}.{what_decides(shown)}"
    )
    return panels.Drawing(shown.figure, caption, shown.runs, f"R{stand}; {median}.")
