"""Figure 7: networks balance."""

from typing import TYPE_CHECKING

from upswing.figures.captions import ENSEMBLE, ORDERED_BY_FALLS
from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from collections.abc import Mapping

    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results
    from upswing.study.claims import Claim

CELL = "balancing/networks-5/alpha-1"
TABLE = "balancing/table/alpha-1"
FIGURE = Declaration(
    "Networks in the balancing task, α = 1", "§4.5.2", ("C4", "C5", "C6"), (CELL, TABLE), number=7
)


def draw(results: "Results", claims: "Mapping[str, Claim]") -> "Drawing":
    """The angle over 5,000 and 50,000 steps, and the falls of all runs beside the table's."""
    from upswing.figures import panels, told
    from upswing.figures.captions import what_decides
    from upswing.figures.lengths import in_steps
    from upswing.figures.success_share import frequency, share
    from upswing.figures.three_and_all import Row, three_and_all

    rows = [Row(CELL, "networks, α = 1", 5_000), Row(CELL, "networks, α = 1")]
    shown = three_and_all(results, rows, claims, [(TABLE, "table")])
    found = share(results, CELL)
    early, late = (
        [told.times(told.middle(results, cell, name)) for cell in (CELL, TABLE)]
        for name in ("falls_first_5000", "falls_last_fifth")
    )
    runs = results.counted(CELL)
    falling = runs.loc[runs["falls_last_fifth"] > 0, "falls_last_fifth"]
    others = (
        f" The other {len(falling)} fall there {told.times(falling.median())} in the median."
        if 0 < len(falling) < found.of
        else ""
    )
    caption = (
        "Q-learning with three networks of 80-5-1 neurons in the balancing task, α = 1: the first "
        f"5,000 steps above, the whole run below. Left: the angle. {ORDERED_BY_FALLS}. Right: falls "
        f"of all {len(results.cell(CELL))} runs; {ENSEMBLE}, the dashed line the median of the table "
        "with α = 1 (figure 5). What to see: in the median, networks fall "
        f"{early[0]} in the first {in_steps(5_000, [results.task(CELL)])} and {late[0]} in their last "
        f"fifth; the table falls "
        f"{early[1]} and {late[1]} respectively. {frequency(results, CELL)}{others}{what_decides(shown)}"
    )
    alt = f"Networks: {frequency(results, CELL)}{others}"
    return panels.Drawing(shown.figure, caption, shown.runs, alt)
