"""How figures look: Matplotlib's settings, and nothing that changes them for anybody else."""

from typing import Any

GRID = "#DDDDDD"

SMALL = 7.0
"""Size of what is written beside dots and on the picture [pt]."""

MUTED = "#555555"
"""What is there, but not to be seen first: ticks, thresholds."""

APPEARANCE: Any = {
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
    "svg.fonttype": "none",  # text that can be selected and read out
    "path.simplify_threshold": 0.5,
}
