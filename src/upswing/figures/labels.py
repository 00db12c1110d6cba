"""What is written at the axes of panels: labels of lines, steps and angles."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, FuncFormatter

from upswing.analysis.colours import of_text
from upswing.figures.lengths import step_label
from upswing.study.task import Task

LINE = 0.14
"""Height of a label [inch]."""

LEADER: Any = {"arrowstyle": "-", "linewidth": 0.5, "shrinkA": 0, "shrinkB": 0, "relpos": (0, 0.5)}
"""The line from a label to where its line ends, where the two had to be moved apart."""

NAMED = {0: "upright", 180: "hanging"}
"""Angles that are called by a name [°]."""


def label_ends(axes: Axes, ends: Sequence[tuple[float, str, str]]) -> None:
    """Name each median at its right end, moved apart where they would overlap."""
    low, high = axes.get_ylim()
    whole = axes.get_figure(root=True)
    assert whole is not None  # noqa: S101
    inches = whole.get_size_inches()[1] * axes.get_position().height
    gap = LINE / inches * (high - low)
    ordered = sorted(ends)
    places: list[float] = []
    for value, _, _ in ordered:
        places.append(max(value, places[-1] + gap if places else value))
    for number in reversed(range(len(places))):  # and none above the panel
        places[number] = min(places[number], high - gap * (len(places) - 1 - number))
    for place, (value, label, shade) in zip(places, ordered, strict=True):
        moved = abs(place - value) > gap / 2
        axes.annotate(
            label, (1.0, value), (1.06 if moved else 1.02, place), xycoords=("axes fraction", "data"),
            textcoords=("axes fraction", "data"), color=of_text(shade), va="center",
            annotation_clip=False, arrowprops=LEADER | {"color": shade} if moved else None,
        )  # fmt: skip


def steps_axis(axes: Axes, tasks: Iterable[Task], most: int = 5) -> None:
    """An axis of steps, written short; its last tick stands at its end.

    Args:
        axes: those of the panel, with their limits.
        tasks: those of the runs that it shows, which say how long a step is.
        most: number of parts that it may be cut into.
    """
    last = axes.get_xlim()[1]
    axes.xaxis.set_major_formatter(FuncFormatter(_short))
    axes.xaxis.set_major_locator(FixedLocator(list(np.linspace(0, last, _parts(last, most) + 1))))
    axes.set_xlabel(step_label(tasks))


def _parts(last: float, most: int) -> int:
    """Into how many equal parts an axis is cut, so that ticks are round: the most that do."""
    for digits in (1, 2, 3):
        for parts in sorted({4, 5, 3, 2}, reverse=True):
            if parts <= most and float(f"{last / parts:.{digits}g}") == last / parts:
                return parts
    return 1


def _short(value: float, _: int) -> str:
    """A number of steps, written short: 500, 15k, 2.5M."""
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if value >= size:
            return f"{value / size:.4g}{letter}"
    return f"{value:g}"


def angle_axis(axes: Axes) -> None:
    """An axis of angles [°], upright and hanging called so."""
    axes.yaxis.set_major_formatter(FuncFormatter(_named))
    axes.set_ylabel("angle φ")


def _named(degrees: float, _: int) -> str:
    """An angle, by its name if it has one."""
    return NAMED.get(round(degrees), f"{degrees:g}°".replace("-", "−"))
