"""The pendulum for a slide: a picture that moves in real time, or some moments side by side."""

from functools import cached_property
from math import ceil, inf
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageColor, ImageDraw, ImageFont

from upswing.physics.environment import State, Trajectory
from upswing.physics.pendulum import Pendulum
from upswing.physics.picture import picture
from upswing.runs.files.atomic import written
from upswing.runs.metrics import UPRIGHT

A_PICTURE = 40
"""From one picture to the next: 25 a second; a GIF knows multiples of 10 [ms]."""

A_POINT = 0.01
"""From one point of the angle's curve to the next, about [s]."""

SAID = 0.5
"""How long it is said that there was a push [s]."""

WIDTH, HEIGHT, STRIP = 480, 320, 90
"""Of a picture of the pendulum, and the height of the strip below it [pixels]."""

MOMENTS, COLUMNS = 8, 4
"""Number of pictures of a slide that does not move."""

LEFT, RIGHT, TOP, BOTTOM = 44, 12, 8, 22
"""Around the angle's curve [pixels]."""

FINER = 2
"""Everything is drawn so many times as large, and made smaller: then its edges are smooth."""

INK, PALE, BAND, CURVE, PUSH = "#3b4252", "#8a93a5", "#d3efe5", "#0072b2", "#d55e00"


class Slide:
    """What is drawn of a trajectory.

    Args:
        body: the pendulum.
        trajectory: what it did.
        pushed_at: the step before which it was pushed; None if it was not.
        limit: the angle's curve shows ± this [°].
        track: the cart goes no further than |x| = this [m].
    """

    def __init__(
        self,
        body: Pendulum,
        trajectory: Trajectory,
        pushed_at: int | None,
        limit: int,
        track: float = inf,
    ) -> None:
        self._body, self._trajectory, self._track = body, trajectory, track
        self._pushed_at, self._limit = pushed_at, limit
        self.steps = len(trajectory.angle)
        self.time_step = body.time_step

    @property
    def in_real_time(self) -> list[int]:
        """The steps at which pictures are drawn that follow each other every ``A_PICTURE`` ms."""
        each = A_PICTURE / 1_000 / self.time_step
        count = max(1, ceil(round(self.steps / each, 6)))
        return [min(round(number * each), self.steps - 1) for number in range(count)]

    def moment(self, step: int) -> Image.Image:
        """The pendulum at a step, its angle's curve below it with a mark, and the time."""
        image = Image.new("RGB", (WIDTH, HEIGHT + STRIP))
        image.paste(self._pendulum(step).reduce(FINER), (0, 0))
        image.paste(self._curve, (0, HEIGHT))
        x = round(self._across(step, WIDTH) / FINER)
        mark = [(x, HEIGHT + TOP), (x, HEIGHT + STRIP - BOTTOM)]
        ImageDraw.Draw(image).line(mark, "firebrick", 2)
        return image

    def moments(self) -> Image.Image:
        """Some moments at equal distances, and the curve below the last row of them."""
        rows = -(-MOMENTS // COLUMNS)
        image = Image.new("RGB", (WIDTH * COLUMNS // 2, (HEIGHT // 2) * rows + STRIP), "white")
        for place, step in enumerate(np.linspace(0, self.steps - 1, MOMENTS).round().astype(int)):
            row, column = divmod(place, COLUMNS)
            small = self._pendulum(int(step)).reduce(2 * FINER)
            image.paste(small, (WIDTH // 2 * column, HEIGHT // 2 * row))
        image.paste(self._drawn_curve(image.width), (0, HEIGHT // 2 * rows))
        return image

    def _pendulum(self, step: int) -> Image.Image:
        columns = (
            self._trajectory.angle,
            self._trajectory.angular_velocity,
            self._trajectory.cart_position,
            self._trajectory.cart_velocity,
        )
        state = State(*(float(column[step]) for column in columns))
        image = Image.fromarray(picture(self._body, state, WIDTH * FINER, self._track))
        draw, seconds = ImageDraw.Draw(image), step * self.time_step
        draw.text((10 * FINER, 8 * FINER), f"{seconds:.2f} s", INK, _font(20))
        pushed = self._pushed_at
        if pushed is not None and 0 <= (step - pushed) * self.time_step < SAID:
            draw.text((10 * FINER, 34 * FINER), "push", PUSH, _font(20))
        return image

    @cached_property
    def _curve(self) -> Image.Image:
        return self._drawn_curve(WIDTH)

    def _drawn_curve(self, width: int) -> Image.Image:
        """The angle over time; the band is upright."""
        image = Image.new("RGB", (width * FINER, STRIP * FINER), "white")
        draw = ImageDraw.Draw(image)
        right = (width - RIGHT) * FINER
        upright = float(np.degrees(UPRIGHT))
        corners = [(LEFT * FINER, self._up(upright)), (right, self._up(-upright))]
        draw.rectangle(corners, fill=BAND)
        if self._pushed_at is not None and self._pushed_at < self.steps:
            x = self._across(self._pushed_at, width)
            draw.line([(x, TOP * FINER), (x, (STRIP - BOTTOM) * FINER)], PUSH, FINER)
        for points in self._lines(width):
            draw.line(points, CURVE, round(1.5 * FINER))
        for angle in (self._limit, 0, -self._limit):
            text = f"{angle}°"
            draw.text(((LEFT - 6) * FINER, self._up(angle)), text, PALE, _font(11), anchor="rm")
        seconds = self.steps * self.time_step
        for time, anchor in ((0.0, "lt"), (seconds, "rt")):
            at = (self._across(time / self.time_step, width), (STRIP - BOTTOM + 6) * FINER)
            draw.text(at, f"{time:g} s", PALE, _font(11), anchor=anchor)
        return image.reduce(FINER)

    def _lines(self, width: int) -> list[list[tuple[float, float]]]:
        """The angle within one turn; a new line begins where it jumps by a turn."""
        turned = np.degrees(self._trajectory.angle.astype(float) + np.pi) % 360 - 180
        steps = np.arange(0, self.steps, max(1, round(A_POINT / self.time_step)))
        shown = turned[steps]
        jumps = np.flatnonzero(np.abs(np.diff(shown)) > 180) + 1
        return [
            [
                (self._across(step, width), self._up(angle))
                for step, angle in zip(*part, strict=True)
            ]
            for part in zip(np.split(steps, jumps), np.split(shown, jumps), strict=True)
            if len(part[0]) > 1
        ]

    def _across(self, step: float, width: int) -> float:
        return FINER * (LEFT + (width - LEFT - RIGHT) * step / self.steps)

    def _up(self, angle: float) -> float:
        middle, half = (TOP + STRIP - BOTTOM) / 2, (STRIP - BOTTOM - TOP) / 2
        return FINER * (middle - half * angle / self._limit)


def write_slide(path: Path, slide: Slide) -> None:
    """Write a slide: a GIF moves, in real time and again and again; a PNG does not.

    Raises:
        OSError: it cannot be written.
    """
    with written(path) as beside:
        if path.suffix.lower() == ".png":
            slide.moments().save(beside, format="PNG", optimize=True)
            return
        palette = _palette()
        first, *others = (
            slide.moment(step).quantize(palette=palette, dither=Image.Dither.NONE)
            for step in slide.in_real_time
        )
        first.save(
            beside,
            format="GIF",
            save_all=True,
            append_images=others,
            duration=A_PICTURE,
            loop=0,
        )


def _palette() -> Image.Image:
    """The colours that are drawn with, and what lies between each and the white around it."""
    drawn = (INK, PALE, BAND, CURVE, PUSH, "firebrick", "grey", "black")
    parts = [255, 255, 255]
    for colour in drawn:
        for share in (1.0, 0.75, 0.5, 0.25):
            parts += [round(255 + share * (part - 255)) for part in ImageColor.getrgb(colour)[:3]]
    palette = Image.new("P", (1, 1))
    palette.putpalette(parts)
    return palette


def _font(size: int) -> Any:
    return ImageFont.load_default(size * FINER)
