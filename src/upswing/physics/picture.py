"""A picture of the pendulum on its cart, as the environments render it and as slides show it."""

from math import ceil, inf

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from upswing.physics.elementary import sine_and_cosine
from upswing.physics.environment import State
from upswing.physics.pendulum import Pendulum

WIDTH = 240
"""Of a picture [pixels]; its height is two thirds of that."""

VIEW = 4.5
"""What a picture shows from left to right [lengths of the rod]."""

MARKS = 0.5
"""Between two marks on the ground, by which one sees the cart move [lengths of the rod]."""


def picture(
    body: Pendulum, state: State, width: int = WIDTH, track_limit: float = inf
) -> NDArray[np.uint8]:
    """The pendulum on its cart, which stays in the middle while the ground passes.

    Args:
        body: how long the pendulum is [m].
        state: its angle [rad] and where the cart is [m].
        width: of the picture [pixels].
        track_limit: how far the cart can go to either side [m]; a wall stands there.

    Returns:
        Red, green and blue, shape (2/3 width, width, 3).
    """
    height = width * 2 // 3
    metre = width / (VIEW * body.length)  # in pixels
    unit = width / WIDTH  # by which lines and the cart grow with the picture
    image = Image.new("RGB", (width, height), "white")
    draw = ImageDraw.Draw(image)
    ground, middle = height * 0.6, width / 2
    thin = max(1, round(unit))
    across, up = 14 * unit, 5 * unit
    # Its ends are where the cart, and not its middle, meets a wall.
    left, right = (
        middle + (end - state.cart_position) * metre + beside
        for end, beside in ((-track_limit, -across), (track_limit, across))
    )
    draw.line([(max(0, left), ground), (min(width, right), ground)], fill="grey", width=thin)
    for wall in (left, right):
        if 0 <= wall <= width:
            draw.line([(wall, ground - 4 * up), (wall, ground)], fill="grey", width=3 * thin)
    for at in _marks(state.cart_position, body.length):
        x = middle + at * metre
        if not left <= x <= right:
            continue
        draw.line([(x, ground), (x, ground + 4 * unit)], fill="grey", width=thin)
    draw.rectangle([middle - across, ground - up, middle + across, ground + up], fill="black")
    sine, cosine = sine_and_cosine(state.angle)
    # M_C of eq. 16 turns φ towards where the cart accelerates: a positive φ leans to negative x.
    reach = body.orientation * body.length * metre
    tip = (middle - reach * sine, ground - reach * cosine)
    draw.line([(middle, ground), tip], fill="firebrick", width=round(5 * unit))
    return np.array(image)


def _marks(cart_position: float, length: float) -> list[float]:
    """Where marks of the ground are, from the middle of the picture [m]; the outer ones out of view."""
    apart, each_side = MARKS * length, ceil(VIEW / 2 / MARKS)
    return [apart * i - cart_position % apart for i in range(-each_side, each_side + 2)]
