"""Colours of cells on the viewer's dark ground: an architecture's own, in a shade for each step size."""

from collections.abc import Iterable

from upswing.analysis.colours import rgb
from upswing.study.ids import CellId
from upswing.study.names import NO_ALPHA

Colour = tuple[int, int, int]

BLACK, WHITE = (0, 0, 0), (255, 255, 255)
DARKEST, LIGHTEST = 0.35, 0.65
"""How much of black the largest step size has, and of white the smallest."""

VISIBLE = 110
"""The brightest part of a colour that is told from the ground, at least."""


def shades(cells: Iterable[str]) -> dict[str, Colour]:
    """A colour for each cell: of an architecture's step sizes the largest is darkest."""
    found = {}
    cells = list(cells)
    for cell in cells:
        one = CellId.parse(cell)
        alphas = sorted(
            {
                float(other.alpha)
                for other in map(CellId.parse, cells)
                if other.architecture == one.architecture and other.alpha != NO_ALPHA
            },
            reverse=True,
        )
        own = visible(rgb(cell))
        if len(alphas) > 1:
            place = 2 * alphas.index(float(one.alpha)) / (len(alphas) - 1) - 1
            own = (
                mixed(own, WHITE, place * LIGHTEST)
                if place > 0
                else mixed(own, BLACK, -place * DARKEST)
            )
        found[cell] = own
    return found


def visible(colour: Colour) -> Colour:
    """A colour, lighter if it would not be seen on a dark ground."""
    brightest = max(colour)
    return (
        colour
        if brightest >= VISIBLE
        else mixed(colour, WHITE, (VISIBLE - brightest) / (255 - brightest))
    )


def mixed(one: Colour, other: Colour, share: float) -> Colour:
    """A colour with a share of another."""
    red, green, blue = (round(a + share * (b - a)) for a, b in zip(one, other, strict=True))
    return red, green, blue
