"""Axes, legends and the scale of colours of the maps of a recording: the viewer draws none for pictures.

All of it is in the pixels of the maps, outside of them. What is the same for all runs is made once.
"""

from functools import cache
from itertools import pairwise
from math import degrees
from typing import NamedTuple

import numpy as np
import rerun as rr

from upswing.physics.actions import signed
from upswing.runs.recording.actions import Colour, action_colours, action_names

SIDE = 80
"""Of a map, about: a tile has as many whole pixels as come to that [pixels]."""

LEFT, ABOVE = 24, 14
"""Room that a view leaves beside a map, for the axes [pixels]."""

LEGEND, ROW = 15, 7
"""How far below a map its legend begins, and the height of a row of it [pixels]."""

FEW = 5
"""So many actions have a row each in the legend; of more, some stand side by side."""

ABREAST, APART = 4, 22
"""Number of actions side by side, and the distance from one to the next [pixels]."""

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
    velocity_limit: float  # … and ± this [rad/s]
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


class Legend(NamedTuple):
    """A colour of the policy's map in words."""

    words: str
    across: float  # from the middle of the map [pixels]
    row: int
    colour: Colour


def below(actions: int) -> int:
    """Room that a view leaves below a map for axes and a legend of so many actions [pixels]."""
    most = legend(2, tuple(map(float, range(actions))))
    return LEGEND + ROW * (most[-1].row + 1) + ROW + 3


@cache
def legend(modules: int, accelerations: tuple[float, ...]) -> tuple[Legend, ...]:
    """What the colours of the policy's map mean; ``accelerations`` are the actions' [m/s²]."""
    found: list[Legend] = []
    row = 0
    few = len(accelerations) <= FEW
    for module in range(modules):
        colours = [of_module(colour, module) for colour in action_colours(accelerations)]
        of = f"{MODULES[module]}: " if modules > 1 else ""
        if few:
            for name, colour in zip(action_names(accelerations), colours, strict=True):
                found.append(Legend(f"{of}{name}", 0.0, row, colour))
                row += 1
            continue
        found.append(Legend(f"{of}cart acceleration [m/s²]", 0.0, row, GREY))
        names = map(signed, accelerations)
        for place, (name, colour) in enumerate(zip(names, colours, strict=True)):
            down, across = divmod(place, ABREAST)
            middle = (ABREAST - 1) / 2
            found.append(Legend(name, (across - middle) * APART, row + 1 + down, colour))
        row = found[-1].row + 1
    return (*found, Legend("undecided: dark", 0.0, row, GREY))


def of_module(colour: Colour, module: int) -> Colour:
    """The colour of an action that a module chose: darker for the second."""
    red, green, blue = (int(part * (1 - 0.25 * module)) for part in colour)
    return red, green, blue


def draw_axes(
    recording: rr.RecordingStream, grid: Grid, accelerations: tuple[float, ...], lowest: float
) -> None:
    """Axes of both maps, the policy's legend, and the value's scale down to ``lowest`` [rad²]."""
    for entity, content in _always(grid, accelerations).items():
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
def _always(
    grid: Grid, accelerations: tuple[float, ...]
) -> dict[str, rr.LineStrips2D | rr.Points2D]:
    """What is the same for all runs with such maps, by the entity."""
    places, words = _ticks(grid)
    said = legend(grid.modules, accelerations)
    colours = [GREY] * len(words) + [one.colour for one in said]
    words = [*words, *(one.words for one in said)]
    middle, low = grid.width / 2, grid.height + LEGEND
    places = [*places, *((middle + one.across, low + ROW * one.row) for one in said)]
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
    limit = degrees(grid.angle_limit)
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        found.places.append((share * grid.width, grid.height + 1))
        found.words.append(f"{_brief((2 * share - 1) * limit)}°" if share != 0.5 else "φ = 0")
        found.places.append((-9, share * grid.height - 4))
        velocity = (1 - 2 * share) * grid.velocity_limit
        found.words.append(_brief(velocity) if share != 0.5 else "0")
    found.places.append((0, -13))
    found.words.append("φ̇ [rad/s]")
    return found


def _brief(value: float) -> str:
    """A value at an axis, to three digits."""
    return signed(float(f"{value:.3g}"))


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
    places: list[tuple[float, float]], words: list[str], colours: list[Colour]
) -> rr.Points2D:
    """Words, each below its place."""
    # A viewer that is not asked to shows no more than thirty.
    return rr.Points2D(places, labels=words, colors=colours, radii=[0.01], show_labels=True)
