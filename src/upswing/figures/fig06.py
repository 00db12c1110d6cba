"""Figure 6: the step size decides how stably a Q table balances."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ENSEMBLE, MEDIAN_BY_FALLS
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

    figure, runs = panels.one_and_all(results, list(CELLS.items()))
    count = len(results.cell(next(iter(CELLS))))
    caption = (
        "Q-learning with a table in the balancing task for four step sizes α. Left: the angle. "
        f"{MEDIAN_BY_FALLS}. Right: falls of all {count} runs; {ENSEMBLE}. The scales on the right "
        "differ."
    )
    return panels.Drawing(figure, caption, [run.id for run in runs])
