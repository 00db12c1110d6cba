"""Axes, legends and the scale of colours of the maps of a recording: the viewer draws none for pictures.

All of it is in the pixels of the maps, outside of them. What is the same for all runs is made once.
"""

from functools import cache
from itertools import pairwise
from math import degrees
from typing import NamedTuple

import numpy as np
import rerun as rr

from upswing.agents.features.grid import VELOCITY_LIMIT
from upswing.physics.tasks import ACCELERATIONS

SIDE = 80
"""Of a map, about: a tile has as many whole pixels as come to that [pixels]."""

LEFT, ABOVE, BELOW = 24, 14, 74
"""Room that a view leaves beside a map, for axes and legend [pixels]."""

ACTION_COLOURS = ((0, 114, 178), (221, 221, 221), (213, 94, 0))
ACTION_NAMES = [f"{ẍ:+.0f} m/s²" if ẍ else "0 m/s²" for ẍ in ACCELERATIONS]
UNDECIDED_COLOUR = (90, 90, 90)
MODULES = ("balancing", "upswing")

VIRIDIS = (
    (68, 1, 84), (72, 40, 120), (62, 73, 137), (49, 104, 142), (38, 130, 142), (31, 158, 137),
    (53, 183, 121), (110, 206, 88), (181, 222, 43), (253, 231, 37),
)  # fmt: skip
"""The viewer's colours of a value, from the lowest to zero."""

GREY, PALE = (150, 150, 150), (200, 200, 200)
BANDS = 40
"""Of the scale of colours."""


class Grid(NamedTuple):
    """Of what the maps are pictures."""

    parts: tuple[int, ...]  # of φ and of φ̇
    angle_limit: float  # they cover ± this [rad]
    modules: int

    @property
    def pixels(self) -> tuple[int, int]:
        """The size of a part: of φ and of φ̇ [pixels]."""
        angle, velocity = (max(1, SIDE // parts) for parts in self.parts)
        return angle, velocity

    @property
    def width(self) -> int:
        """Of a map: φ [pixels]."""
        return self.parts[0] * self.pixels[0]

    @property
    def height(self) -> int:
        """Of a map: φ̇ [pixels]."""
        return self.parts[1] * self.pixels[1]


def module_colour(module: int, action: int) -> tuple[int, int, int]:
    """The colour of an action that a module chose: darker for the second."""
    red, green, blue = (int(part * (1 - 0.25 * module)) for part in ACTION_COLOURS[action])
    return red, green, blue


def draw_axes(recording: rr.RecordingStream, grid: Grid, lowest: float) -> None:
    """Axes of both maps, the policy's legend, and the value's scale down to ``lowest`` [rad²]."""
    for entity, content in _always(grid).items():
        recording.log(entity, content, static=True)
    middle, low = grid.width / 2, grid.height + 22
    places = [*_ticks(grid).places, (middle - 34, low), (middle + 34, low), (middle, low + 8)]
    least = f"{lowest:,.3g}" if lowest < -1e-6 else "0"
    words = [*_ticks(grid).words, least, "0", "value: reward to come [rad²]"]
    colours = [GREY] * (len(places) - 3) + [PALE] * 3
    recording.log("learned/marks", _texts(places, words, colours), static=True)


class Texts(NamedTuple):
    """Words, each below its place."""

    places: list[tuple[float, float]]
    words: list[str]


@cache
def _always(grid: Grid) -> dict[str, rr.LineStrips2D | rr.Points2D]:
    """What is the same for all runs with such maps, by the entity."""
    places, words = _ticks(grid)
    legend = [
        (f"{MODULES[module]}: {name}" if grid.modules > 1 else name, module, action)
        for module in range(grid.modules)
        for action, name in enumerate(ACTION_NAMES)
    ]
    colours = [GREY] * len(words) + [module_colour(*which) for _, *which in legend] + [GREY]
    words = [*words, *(text for text, *_ in legend), "undecided: dark"]
    rows = range(len(legend) + 1)
    places = [*places, *((grid.width / 2, grid.height + 15 + 7 * row) for row in rows)]
    frame = _frame(grid)
    bands, shades = _scale(grid)
    return {
        "phase/axes": rr.LineStrips2D(frame, colors=[GREY]),
        "phase/marks": _texts(places, words, colours),
        "learned/axes": rr.LineStrips2D(
            [*frame, *bands],
            colors=[GREY] * len(frame) + shades,
            # A negative radius is one on the screen, in points.
            radii=[-1.0] * len(frame) + [2.5] * len(bands),
        ),
    }


@cache
def _ticks(grid: Grid) -> Texts:
    """What stands at the axes."""
    found = Texts([], [])
    limit = round(degrees(grid.angle_limit))
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        found.places.append((share * grid.width, grid.height + 1))
        found.words.append(f"{(2 * share - 1) * limit:+.0f}°" if share != 0.5 else "φ = 0")
        found.places.append((-9, share * grid.height - 4))
        found.words.append(f"{(1 - 2 * share) * VELOCITY_LIMIT:+.0f}" if share != 0.5 else "0")
    found.places.append((0, -13))
    found.words.append("φ̇ [rad/s]")
    return found


def _frame(grid: Grid) -> list[list[tuple[float, float]]]:
    """The border of a map, with marks."""
    width, height = grid.width, grid.height
    lines: list[list[tuple[float, float]]] = [
        [(0, 0), (width, 0), (width, height), (0, height), (0, 0)]
    ]
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        x, y = share * width, share * height
        lines += [[(x, height), (x, height + 1.5)], [(-1.5, y), (0, y)]]
    return lines


def _scale(
    grid: Grid,
) -> tuple[list[list[tuple[float, float]]], list[tuple[int, ...]]]:
    """The colours of the value, from the lowest to zero: bands side by side, and their colours."""
    along = np.linspace(0, 1, BANDS + 1)
    x = (grid.width / 2 - 34 + 68 * along).tolist()
    stops = np.linspace(0, 1, len(VIRIDIS))
    middles = (along[1:] + along[:-1]) / 2
    colours = np.stack([np.interp(middles, stops, part) for part in np.transpose(VIRIDIS)], axis=1)
    y = grid.height + 18
    bands: list[list[tuple[float, float]]] = [[(begin, y), (end, y)] for begin, end in pairwise(x)]
    return bands, [tuple(colour) for colour in colours.astype(int).tolist()]


def _texts(
    places: list[tuple[float, float]], words: list[str], colours: list[tuple[int, int, int]]
) -> rr.Points2D:
    """Words, each below its place."""
    return rr.Points2D(places, labels=words, colors=colours, radii=[0.01])
