"""What a figure knows of the runs in it, so that a page can point at one: where each is drawn.

While it draws, a figure says of each panel which runs are there (``remember``); once it is laid out,
where they are (``described``). That stands in the figure's words, ``figures/NAME.json``, under
``panels``. Places are parts of the panel, from its lower left corner: who reads them needs no scales.
"""

import base64
from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from upswing.runs.results import Real

POINTS = 100
"""So many points of a line are kept at most: about one every two pixels."""

POINTS_PER_INCH = 72
"""matplotlib draws SVG in points."""

FINE, COARSE = 65_535, 254
"""The largest place in two bytes and in one; one byte has 255 for a line that has ended."""


class Curves(NamedTuple):
    """Runs of a cell, each a line."""

    cell: str
    seeds: Sequence[int]
    x: Real  # (points,), in the unit of the axis
    y: Real  # (runs, points), in the unit of the axis; NaN where a run has ended
    drawn: bool = True  # whether one sees them all, or one only when it is pointed at elsewhere


class Dots(NamedTuple):
    """Runs of a cell, each a dot."""

    cell: str
    seeds: Sequence[int]
    x: Real  # (runs,), in the unit of the axis
    y: Real  # (runs,)


class Alone(NamedTuple):
    """One run, which has the panel to itself."""

    cell: str
    seed: int


_remembered: "WeakKeyDictionary[Axes, list[Curves | Dots | Alone]]" = WeakKeyDictionary()


def remember(axes: Axes, runs: Curves | Dots | Alone) -> None:
    """Say which runs a panel shows."""
    _remembered.setdefault(axes, []).append(runs)


def described(figure: Figure) -> list[dict[str, Any]]:
    """Each panel with runs in it: its place in the SVG [pt, from the upper left] and its runs.

    The figure must have been drawn: before, it is not known where its panels are.
    """
    width, height = figure.get_size_inches() * POINTS_PER_INCH
    found = []
    for axes in figure.axes:
        if axes in _remembered and axes.get_visible():
            place = axes.get_position()
            corner = place.x0 * width, (1 - place.y1) * height
            box = (*corner, place.width * width, place.height * height)
            runs = [_runs(axes, one) for one in _remembered[axes]]
            found.append({"box": [round(float(side), 2) for side in box], "runs": runs})
    return found


def _runs(axes: Axes, runs: Curves | Dots | Alone) -> dict[str, Any]:
    if isinstance(runs, Alone):
        return {"kind": "alone", "cell": runs.cell, "seeds": [[int(runs.seed)] * 2]}
    seeds = _ranges(runs.seeds)
    if isinstance(runs, Dots):
        across, up = _places(axes, runs.x, runs.y)
        return {
            "kind": "dots", "cell": runs.cell, "seeds": seeds,
            "x": _packed(across * FINE, "<u2"), "y": _packed(up * FINE, "<u2"),
        }  # fmt: skip
    x, y = np.asarray(runs.x, float), np.asarray(runs.y, float)
    low, high = axes.get_xlim()
    shown = np.flatnonzero((low <= x) & (x <= high))
    if len(shown) > POINTS:
        shown = shown[np.linspace(0, len(shown) - 1, POINTS).astype(int)]
    y = y[:, shown]
    x = np.broadcast_to(x[shown], y.shape)
    across, up = _places(axes, x, y)
    return {
        "kind": "curves", "cell": runs.cell, "seeds": seeds, "drawn": runs.drawn,
        "x": _packed((across[0] if len(across) else across) * FINE, "<u2"),
        "y": _packed(np.where(np.isnan(up), COARSE + 1, up * COARSE), "<u1"),
    }  # fmt: skip


def _places(axes: Axes, x: Real, y: Real) -> tuple[Real, Real]:
    """Points as parts of a panel, 0 to 1; what lies without stands on its edge."""
    points = np.stack([np.ravel(x).astype(float), np.ravel(y).astype(float)], axis=1)
    inside = (axes.transData - axes.transAxes).transform(points).clip(0, 1)
    return inside[:, 0].reshape(np.shape(x)), inside[:, 1].reshape(np.shape(y))


def _packed(values: Real, kind: str) -> str:
    return base64.b64encode(np.rint(values).astype(kind).tobytes()).decode("ascii")


def _ranges(seeds: Sequence[int]) -> list[list[int]]:
    """Seeds in their order as [first, last] of stretches without a gap."""
    known = [int(seed) for seed in seeds]
    breaks = [0, *(n for n, (a, b) in enumerate(pairwise(known), 1) if b != a + 1), len(known)]
    return [[known[a], known[b - 1]] for a, b in pairwise(breaks) if b > a]
