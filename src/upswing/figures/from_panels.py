"""A figure that a study declares from ready panels, without any code."""

from collections.abc import Callable, Mapping, Sequence
from math import ceil

import numpy as np
from matplotlib.axes import Axes

from upswing.analysis.colours import colour, label
from upswing.figures import decisive, panels
from upswing.figures.captions import ANGLE_HISTOGRAM, ENSEMBLE, claims_decided
from upswing.figures.decided import decided
from upswing.figures.interaction import Dots, remember
from upswing.figures.measures import described
from upswing.figures.over_alpha import success_over_alpha, title_of
from upswing.figures.panels import Drawing
from upswing.figures.style import empty
from upswing.runs.results import Results
from upswing.study.claims import Claim
from upswing.study.ids import CellId
from upswing.study.own_figures import DeclaredFigure, DeclaredPanel

COLUMNS = 2
"""Largest number of panels in a row."""

HEIGHT, ROW = 2.3, 0.19
"""Height of a panel, and of each cell of one that has a row for each [inch]."""

RANKS = ("worst", "median", "best")
WHOLE_TURN = 180
"""The largest angle of a task that has no end of it [°]."""


def draw(declared: DeclaredFigure, results: Results, claims: Mapping[str, Claim]) -> Drawing:
    """Its panels, two in a row, and below them what decides the claims that name it.

    Args:
        declared: what it shows.
        results: the runs.
        claims: the claims that name it.
    """
    found, lacking = decided(results, claims)
    across = min(COLUMNS, len(declared.panels))
    heights = [HEIGHT] * ceil(len(declared.panels) / across)
    for number, panel in enumerate(declared.panels):
        if panel.panel == "measure":
            row = number // across
            heights[row] = max(heights[row], ROW * len(panel.cells) + 0.8)
    below = [decisive.height(found)] if found else []
    figure = empty(sum(heights) + sum(below))
    parts = figure.add_gridspec(1 + len(below), 1, height_ratios=[sum(heights), *below])
    grid = parts[0].subgridspec(len(heights), across, height_ratios=heights)
    said: list[str] = []
    runs: list[str] = []
    for number, panel in enumerate(declared.panels):
        axes = figure.add_subplot(grid[number // across, number % across])
        shown, words = PANELS[panel.panel](axes, panel, results)
        if panel.title:
            axes.set_title(panel.title)
        runs += shown
        said.append(words)
    if found:
        decisive.draw(figure, parts[1], found, results)
    whole = [
        declared.caption,
        *(f"{words[0].upper()}{words[1:]}." for words in dict.fromkeys(said)),
        claims_decided(found, lacking).strip(),
    ]
    return Drawing(figure, " ".join(filter(None, whole)), list(dict.fromkeys(runs)), _alt(declared))


def _alt(declared: DeclaredFigure) -> str:
    """What it shows, for who does not see it."""
    return f"{declared.title}. {declared.caption}".strip()


Drawn = tuple[list[str], str]
"""The single runs that a panel shows, and what it shows, in words."""


def _angle(axes: Axes, panel: DeclaredPanel, results: Results) -> Drawn:
    cell = panel.cells[0]
    run = results.worst_median_best(cell)[RANKS.index(panel.run)]
    if run.task.angle_limit < WHOLE_TURN:
        panels.angle(axes, run, cell)
        words = "the angle of single runs"
    else:
        panels.angle_histogram(axes, run, cell)
        words = f"angles: {ANGLE_HISTOGRAM}"
    axes.set_title(f"{label(cell)}: {panel.run} run (seed {run.seed})")
    return [run.id], words


def _falls(axes: Axes, panel: DeclaredPanel, results: Results) -> Drawn:
    panels.falls(axes, [(cell, label(cell), results.ensemble(cell)) for cell in panel.cells])
    return [], f"falls so far over the steps: {_lines(panel.cells)}"


def _upright(axes: Axes, panel: DeclaredPanel, results: Results) -> Drawn:
    panels.upright(axes, [(cell, label(cell), results.ensemble(cell)) for cell in panel.cells])
    return [], f"the share of steps with |φ| ≤ 20°: {_lines(panel.cells)}"


def _lines(cells: Sequence[str]) -> str:
    """What the lines of an ensemble are."""
    others = "; dashed lines are the medians of the others" if len(cells) > 1 else ""
    of = f" of {label(cells[0])}" if others else ""
    return f"{ENSEMBLE}{of}{others}"


def _measure(axes: Axes, panel: DeclaredPanel, results: Results) -> Drawn:
    measure = str(panel.measure)
    scale = described(measure, [results.task(cell) for cell in panel.cells])
    tasks = {CellId.parse(cell).task for cell in panel.cells}
    names = []
    for row, cell in enumerate(panel.cells):
        runs = results.counted(cell)
        results.check_measures(runs, [measure])
        values = scale.factor * runs[measure].to_numpy(float)
        # Seeds lie a little apart, in their order.
        places = row + np.linspace(-decisive.APART, decisive.APART, len(values))
        many = len(values) * len(panel.cells) > decisive.DRAWN_AS_DOTS
        axes.scatter(
            values, places, s=5, color=colour(cell), alpha=0.6, linewidths=0, rasterized=many
        )
        remember(axes, Dots(cell, [int(seed) for seed in runs["seed"]], values, places))
        lost = len(results.cell(cell)) - len(runs)
        of_task = "" if len(tasks) == 1 else f"{CellId.parse(cell).task}: "
        names.append(f"{of_task}{label(cell)}" + (f" ({lost} diverged)" if lost else ""))
    axes.set_yticks(range(len(names)), names)
    axes.set(ylim=(len(names) - 0.5, -0.5), xlabel=scale.label)
    axes.grid(visible=False, axis="y")
    if scale.within is not None:
        axes.set_xlim(scale.within[0] - 3, scale.within[1] + 3)
    return [], "where each run is a dot, seeds lie from top to bottom"


def _step_sizes(axes: Axes, panel: DeclaredPanel, results: Results) -> Drawn:
    cells_of: dict[str, dict[float, str]] = {}
    for cell in panel.cells:
        one = CellId.parse(cell)
        cells_of.setdefault(one.architecture, {})[float(one.alpha)] = cell
    success_over_alpha(axes, results, cells_of)
    axes.set_title(title_of(results.task(panel.cells[0]), CellId.parse(panel.cells[0]).task))
    return [], "shares of runs that succeed have their 95 % interval (Wilson)"


PANELS: dict[str, Callable[[Axes, DeclaredPanel, Results], Drawn]] = {
    "angle": _angle,
    "falls": _falls,
    "upright": _upright,
    "measure": _measure,
    "step-sizes": _step_sizes,
}
