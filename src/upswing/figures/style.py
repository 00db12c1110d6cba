"""One visual language for all figures."""

from pathlib import Path
from typing import Any, NamedTuple

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.pyplot import subplots as subplots

from upswing.figures.appearance import APPEARANCE
from upswing.figures.appearance import GRID as GRID
from upswing.figures.interaction import described
from upswing.runs.files.atomic import written
from upswing.study.ids import CellId

WIDTH = 7.2
"""Width of a figure [inch]: a page's text, readable at half of it."""

ROW_HEIGHT = 1.9

LOW, LOWEST = 0.78, 0.52
"""Height of a low panel with its title, and what it may come to where there are many [inch]."""

TALLEST = 10.3
"""How high a figure should be at most: as a page of A4 that is as wide [inch]."""

AXIS = 0.3
"""Height of what stands below a panel [inch]."""

plt.rcParams.update(APPEARANCE)


def dashes(cell: str) -> str:
    """How the line of a cell is drawn: dashed if it has modules, so that it is seen over its equal."""
    return "-" if filled(cell) else "--"


def filled(cell: str) -> bool:
    """Whether a cell's points are filled: hollow if it has modules."""
    return not CellId.parse(cell).architecture.startswith("modular")


def grid_of_panels(
    rows: int, widths: tuple[float, float] = (3, 2), height: float = ROW_HEIGHT
) -> tuple[Figure, list[Axes]]:
    """A figure of ``rows`` × 2 panels, each ``height`` high [inch]."""
    figure, axes = plt.subplots(
        rows, 2, figsize=(WIDTH, height * rows), width_ratios=widths, squeeze=False
    )
    return figure, [panel for row in axes for panel in row]


def empty(height: float) -> Figure:
    """A figure without panels, as wide as a page and ``height`` high [inch]."""
    return plt.figure(figsize=(WIDTH, height))


class Stacked(NamedTuple):
    """A figure of rows, each a stack of low panels on the left and one panel on the right."""

    figure: Figure
    rows: list[tuple[list[Axes], Axes]]
    below: SubplotSpec | None  # room for more, over the whole width


def stacks_and_panels(rows: int, of: int, low: float = LOW, below: float = 0.0) -> Stacked:
    """Such a figure.

    Args:
        rows: number of rows.
        of: number of low panels in a stack.
        low: height of a low panel with its title [inch]; less, where the figure were too tall.
        below: height of what is drawn below the rows [inch].
    """
    low = max(LOWEST, min(low, ((TALLEST - below) / rows - AXIS) / of))
    heights = [(low * of + AXIS) * rows, *([below] if below else [])]
    figure = plt.figure(figsize=(WIDTH, sum(heights)))
    whole = figure.add_gridspec(len(heights), 1, height_ratios=heights)
    grid = whole[0].subgridspec(rows, 2, width_ratios=(3, 2), hspace=0.0)
    found = []
    for row in range(rows):
        left = grid[row, 0].subgridspec(of, 1, hspace=0.0)
        stack = [figure.add_subplot(left[number]) for number in range(of)]
        found.append((stack, figure.add_subplot(grid[row, 1])))
    return Stacked(figure, found, whole[1] if below else None)


def save(figure: Figure, place: Path) -> list[dict[str, Any]]:
    """Write a figure as ``place``.svg and ``place``.png; returns what the SVG's panels show.

    See ``interaction.described``.
    """
    # Lines are the more simplified, the coarser the picture; what is drawn in pixels must be fine.
    in_pixels = bool(figure.findobj(lambda artist: bool(artist.get_rasterized())))
    svg = {"metadata": {"Date": None}, **({"dpi": 200} if in_pixels else {})}
    for ending, options in (("png", {"dpi": 200}), ("svg", svg)):
        with written(place.with_suffix(f".{ending}")) as beside:
            figure.savefig(beside, format=ending, **options)
    panels = described(figure)  # as it was drawn last, for the SVG: layouts differ a little
    plt.close(figure)
    return panels
