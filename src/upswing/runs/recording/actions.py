"""How the actions of a pendulum are called and coloured, however many there are."""

from functools import cache

from upswing.physics.actions import signed

Colour = tuple[int, int, int]

LEFT, NONE, RIGHT = (0, 114, 178), (221, 221, 221), (213, 94, 0)
"""The colours of the strongest push to the left, of none, and of the strongest to the right."""

UNDECIDED_COLOUR = (90, 90, 90)
"""Where several actions are worth the same."""


def action_names(accelerations: tuple[float, ...]) -> list[str]:
    """What actions are called, by their accelerations [m/s²]: ``+10 m/s²``."""
    return [f"{signed(ẍ)} m/s²" for ẍ in accelerations]


@cache
def action_colours(accelerations: tuple[float, ...]) -> tuple[Colour, ...]:
    """A colour for each action: pale for none, and from there to that of the strongest on its side.

    Those of a side are evenly apart, in the order of their strength, so that no two look alike however
    near their accelerations [m/s²] are.
    """
    left = sorted((ẍ for ẍ in accelerations if ẍ < 0), reverse=True)
    right = sorted(ẍ for ẍ in accelerations if ẍ > 0)
    sides = ((left, LEFT), (right, RIGHT))
    colours = {0.0: NONE} | {
        ẍ: _between(NONE, strongest, rank / len(side))
        for side, strongest in sides
        for rank, ẍ in enumerate(side, 1)
    }
    return tuple(colours[ẍ] for ẍ in accelerations)


def _between(one: Colour, other: Colour, share: float) -> Colour:
    """A colour with a share of another."""
    red, green, blue = (round(a + share * (b - a)) for a, b in zip(one, other, strict=True))
    return red, green, blue
