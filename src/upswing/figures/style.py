"""One visual language for all figures."""

from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from upswing.store.files import written

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


def grid_of_panels(rows: int, widths: tuple[float, float] = (3, 2)) -> tuple[Figure, list[Axes]]:
    """A figure of ``rows`` × 2 panels: one run on the left, the crowd on the right."""
    figure, axes = plt.subplots(
        rows, 2, figsize=(WIDTH, ROW_HEIGHT * rows), width_ratios=widths, squeeze=False
    )
    return figure, [panel for row in axes for panel in row]


def save(figure: Figure, place: Path) -> None:
    """Write a figure as ``place``.svg and ``place``.png."""
    for ending, options in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 200})):
        with written(place.with_suffix(f".{ending}")) as beside:
            figure.savefig(beside, format=ending, **options)
    plt.close(figure)
