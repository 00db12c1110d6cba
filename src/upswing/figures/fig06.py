"""Figure 6: the step size decides how stably a Q table balances."""

from itertools import pairwise
from typing import TYPE_CHECKING

from upswing.figures.captions import ENSEMBLE, ORDERED_BY_FALLS
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from collections.abc import Mapping

    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results
    from upswing.study.claims import Claim

CELLS = {
    f"balancing/table/alpha-{alpha}": f"α = {alpha}" for alpha in ("1", "0.75", "0.5", "0.001")
}
NETWORKS = tuple(
    f"balancing/networks-5/alpha-{alpha}" for alpha in ("0.75", "0.5", "0.1", "0.01", "0.001")
)
FIGURE = Declaration(
    "The step size of a Q table, balancing",
    "§4.5.1",
    ("C3", "C6"),
    tuple(CELLS),
    number=6,
    beside=NETWORKS,
)


def draw(results: "Results", claims: "Mapping[str, Claim]") -> "Drawing":
    """The angle and the falls for each of the four step sizes of the thesis."""
    from upswing.figures import panels, told
    from upswing.figures.captions import what_decides
    from upswing.figures.success_share import share
    from upswing.figures.three_and_all import Row, three_and_all

    rows = [Row(cell, label) for cell, label in CELLS.items()]
    shown = three_and_all(results, rows, claims, others=FIGURE.beside)
    sizes = sorted({len(results.cell(cell)) for cell in CELLS})
    values = [share(results, cell).value for cell in CELLS]
    grows = all(one < other for one, other in pairwise(values))
    without = f"uns without a fall in the last fifth: {told.one_by_one(results, CELLS)}"
    caption = (
        "Q-learning with a table in the balancing task for four step sizes α. Left: the angle. "
        f"{ORDERED_BY_FALLS}. Right: falls of all {' or '.join(map(str, sizes))} runs; {ENSEMBLE}. The "
        f"scales on the right differ. What to see: r{without}"
        f"{'; the smaller α, the more' if grows else ''}.{what_decides(shown)}"
    )
    alt = f"R{without}."
    return panels.Drawing(shown.figure, caption, shown.runs, alt)
