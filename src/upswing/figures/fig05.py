"""Figure 5: a Q table balances, with α = 1."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ENSEMBLE, MEDIAN_BY_FALLS
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

CELL = "balancing/table/alpha-1"
FIGURE = Declaration(
    "A Q table in the balancing task, α = 1", "§4.5.1", ("C1", "C2"), (CELL,), number=5
)


def draw(results: "Results") -> "Drawing":
    """The angle over 5,000 and 50,000 steps, and the falls of all runs."""
    from upswing.figures import panels
    from upswing.figures.style import grid_of_panels

    run, ensemble = results.median_run(CELL), results.ensemble(CELL)
    figure, axes = grid_of_panels(2)
    for row, steps in enumerate((5_000, None)):
        panels.angle(axes[2 * row], run, CELL, steps)
        panels.falls(axes[2 * row + 1], [(CELL, "table", ensemble)], steps)
    caption = (
        "Q-learning with a table of 4 × 20 tiles in the balancing task, α = 1: the first 5,000 "
        f"steps above, the whole run below. Left: the angle. {MEDIAN_BY_FALLS}. Right: falls of "
        f"all {len(ensemble.seeds)} runs; {ENSEMBLE}."
    )
    return panels.Drawing(figure, caption, [run.id])
