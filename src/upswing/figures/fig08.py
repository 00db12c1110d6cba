"""Figure 8: a Q table at full control."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, ORDERED_BY_UPRIGHT
from upswing.figures.declaration import Declaration
from upswing.study.ids import CellId

if TYPE_CHECKING:
    from collections.abc import Mapping

    from upswing.figures.panels import Drawing
    from upswing.figures.three_and_all import Shown
    from upswing.runs.results import Results
    from upswing.study.claims import Claim

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

HALF = 0.5


def draw(results: "Results", claims: "Mapping[str, Claim]") -> "Drawing":
    """The angle, and the upright share of all runs beside that of the controls."""
    from upswing.figures import panels, told
    from upswing.figures.captions import phases_named, what_decides
    from upswing.figures.lengths import grid_of
    from upswing.figures.success_share import frequency
    from upswing.figures.three_and_all import Row, three_and_all

    rows = [Row(CELL, "table")]
    shown = three_and_all(results, rows, claims, list(CONTROLS.items()))
    caption = (
        f"Q-learning with a table of {grid_of(results.cells[CELL])} tiles at full control, α = 0.001. "
        f"Left: {ANGLE_HISTOGRAM}. {ORDERED_BY_UPRIGHT}.{phases_named(shown)} Right: the share of "
        f"upright steps of all {len(results.cell(CELL))} runs; {ENSEMBLE}, dashed lines the medians of "
        f"no control and of random actions. What to see: {frequency(results, CELL)} In the whole run "
        f"{told.stood(results, CELL)}.{_most(shown)}{what_decides(shown)}"
    )
    alt = f"With α = 0.001, {frequency(results, CELL)}{_most(shown)}"
    return panels.Drawing(shown.figure, caption, shown.runs, alt)


def _most(shown: "Shown") -> str:
    """With which of the cells that the claims look at most runs stand, as a sentence."""
    shares = [row for one in shown.decided for row in one.evidence if one.part.kind == "share"]
    if not any(row.n for row in shares if row.cells != CELL):
        return ""
    most = {row.cells: row for row in shares if row.estimate > HALF and row.cells != CELL}
    if not most:
        return " In no other cell of the claims do most runs stand."
    words = []
    for row in most.values():
        cell = CellId.parse(row.cells)
        steps = shown.steps[row.cells]
        longer = f" and {steps:,} steps" if steps != shown.steps[CELL] else ""
        words.append(f"α = {cell.alpha}{longer} ({round(row.estimate * row.n)} of {row.n})")
    return f" Most runs stand with {' and with '.join(words)}."
