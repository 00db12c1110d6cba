"""Figure 6: the step size decides how stably a Q table balances."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ENSEMBLE, ORDERED_BY_FALLS
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

CELLS = {
    f"balancing/table/alpha-{alpha}": f"α = {alpha}" for alpha in ("1", "0.75", "0.5", "0.001")
}
FIGURE = Declaration(
    "The step size of a Q table, balancing", "§4.5.1", ("C3",), tuple(CELLS), number=6
)


def draw(results: "Results") -> "Drawing":
    """The angle and the falls for each of the four step sizes of the thesis."""
    from upswing.figures import panels
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    figure, runs = three_and_all(results, [Row(cell, label) for cell, label in CELLS.items()])
    smallest = list(CELLS)[-1]
    caption = (
        "Q-learning with a table in the balancing task for four step sizes α. Left: the angle. "
        f"{ORDERED_BY_FALLS}. Right: falls of all {len(results.cell(smallest))} runs; {ENSEMBLE}. The "
        "scales on the right differ. What to see: the smaller α, the sooner the falls end. With the "
        f"smallest, {frequency(results, smallest)}"
    )
    return panels.Drawing(figure, caption, runs)
