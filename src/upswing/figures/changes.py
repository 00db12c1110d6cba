"""What each change buys: how many runs succeed, and after how many steps."""

from typing import TYPE_CHECKING

from upswing.analysis.beyond_tables import OF_A_CHANGE, REMEDY
from upswing.figures.declaration import Declaration
from upswing.study.paths import CHANGES

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

FIGURE = Declaration("What each change buys", "", ("C8", "C9", "C10", "C12"), tables=(CHANGES,))
ROW = 0.15
"""Height of a cell [inch]."""


def draw(results: "Results") -> "Drawing":
    """A row for each cell of full control, in groups: its share of successes, its steps to stability."""
    import numpy as np

    from upswing.analysis.colours import label, of_text
    from upswing.figures import panels
    from upswing.figures.lengths import in_steps
    from upswing.figures.style import WIDTH, subplots
    from upswing.runs.files.typed_table import read_table
    from upswing.runs.metrics import STABLE_STEPS

    changes = read_table(results.folder / CHANGES, OF_A_CHANGE, REMEDY)
    upright = [results.task(cell).judged_by == "upright" for cell in changes["cell"]]
    table = changes[upright]
    titles = list(dict.fromkeys(table["change"]))
    palette = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#A65628", "#3A97D3", "#777777"]
    shades = {title: palette[n % len(palette)] for n, title in enumerate(titles)}
    figure, (success, stable) = subplots(
        1, 2, figsize=(WIDTH, ROW * (len(table) + 1.4 * len(titles)) + 0.6), sharey=True
    )
    labels, places, row = [], [], 0.0
    for title in titles:
        success.annotate(
            title, (0, row), xycoords=("axes fraction", "data"), va="center", weight="bold",
            color=of_text(shades[title]),
        )  # fmt: skip
        row += 1.1
        for _, cell in table[table["change"] == title].iterrows():
            shade = shades[title]
            success.hlines(
                row, 100 * cell["success_low"], 100 * cell["success_high"], color=shade,
                linewidth=2.5, alpha=0.45,
            )  # fmt: skip
            success.plot(100 * cell["success"], row, "o", color=shade, markersize=3.5)
            if np.isfinite(cell["stable_step"]):
                high = min(cell["stable_high"], cell["steps"])
                stable.hlines(row, cell["stable_low"], high, color=shade, linewidth=2.5, alpha=0.45)
                stable.plot(cell["stable_step"], row, "o", color=shade, markersize=3.5)
            task = (
                ""
                if cell["task"] == "full-control"
                else f"{cell['task'].removeprefix('full-control-')}: "
            )
            labels.append(task + label(cell["cell"]))
            places.append(row)
            row += 1
        row += 0.3
    success.set_yticks(places, labels, fontsize=6)
    success.set_ylim(row, -0.8)
    success.set(xlim=(-3, 103), xlabel="runs that succeed [%]")
    stable.set_xscale("log")
    stable.set_xlabel("step of the first stable window (Kaplan–Meier median)")
    for axes in (success, stable):
        axes.grid(visible=False, axis="y")
    window = in_steps(STABLE_STEPS, [results.task(cell) for cell in table["cell"]])
    caption = (
        "Full control. Left: the share of runs that stand at the end, with its 95 % "
        f"interval (Wilson). Right: when half of the runs had their first window of {window} that is "
        "90 % upright, with its 95 % interval (Kaplan–Meier); nothing where half of them never had one."
    )
    always = int((table["success"] == 1).sum())
    alt = f"All runs succeed in {always} of {len(table)} cells of full control."
    return panels.Drawing(figure, caption, list(changes["median_run"]), alt)
