"""One visual language for all figures."""

from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.pyplot import subplots as subplots

from upswing.runs.files.atomic import written

WIDTH = 7.2
"""Width of a figure [inch]: a page's text, readable at half of it."""

ROW_HEIGHT = 1.9

GRID = "#DDDDDD"

plt.rcParams.update(
    {
        "font.size": 8,
        "axes.titlesize": 8,
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.edgecolor": "#888888",
        "axes.labelcolor": "#333333",
        "xtick.color": "#555555",
        "ytick.color": "#555555",
        "axes.grid": True,
        "grid.color": GRID,
        "grid.linewidth": 0.5,
        "axes.axisbelow": True,
        "figure.constrained_layout.use": True,
        "svg.hashsalt": "upswing",  # the same picture is the same file
        "path.simplify_threshold": 0.5,
    }
)


def grid_of_panels(
    rows: int, widths: tuple[float, float] = (3, 2), height: float = ROW_HEIGHT
) -> tuple[Figure, list[Axes]]:
    """A figure of ``rows`` × 2 panels, each ``height`` high [inch]."""
    figure, axes = plt.subplots(
        rows, 2, figsize=(WIDTH, height * rows), width_ratios=widths, squeeze=False
    )
    return figure, [panel for row in axes for panel in row]


def stacks_and_panels(rows: int, of: int) -> tuple[Figure, list[tuple[list[Axes], Axes]]]:
    """A figure of ``rows``, each a stack of low panels on the left and one panel on the right."""
    figure = plt.figure(figsize=(WIDTH, (0.78 * of + 0.3) * rows))
    grid = figure.add_gridspec(rows, 2, width_ratios=(3, 2))
    found = []
    for row in range(rows):
        left = grid[row, 0].subgridspec(of, 1, hspace=0.12)
        stack = [figure.add_subplot(left[number]) for number in range(of)]
        found.append((stack, figure.add_subplot(grid[row, 1])))
    return figure, found


def save(figure: Figure, place: Path) -> None:
    """Write a figure as ``place``.svg and ``place``.png."""
    # Lines are the more simplified, the coarser the picture; what is drawn in pixels must be fine.
    in_pixels = bool(figure.findobj(lambda artist: bool(artist.get_rasterized())))
    svg = {"metadata": {"Date": None}, **({"dpi": 200} if in_pixels else {})}
    for ending, options in (("svg", svg), ("png", {"dpi": 200})):
        with written(place.with_suffix(f".{ending}")) as beside:
            figure.savefig(beside, format=ending, **options)
    plt.close(figure)
