"""How large things are drawn: by the length of the pendulum, so that any fills its picture alike."""

from math import floor, log10

UNIT = 0.2
"""The length of the pendulum for which sizes are said [m]: that of the thesis."""

HALF_A_CART = 0.05
"""Half the length of the cart, as it is drawn [m]."""

VIEW = (2.0, 1.3)
"""Half the width and half the height of the picture, for a pendulum of length 1."""


def unit_of(length: float) -> float:
    """By what to multiply sizes for a pendulum so long [m]."""
    return length / UNIT


def view_of(length: float) -> tuple[float, float]:
    """Half the width and half the height of the picture of a pendulum so long [m]."""
    across, up = VIEW
    return across * length, up * length


def marks_apart(length: float) -> float:
    """Between two marks on the ground [m]: a round number, half of the pendulum's length or less."""
    most = length / 2
    power = 10.0 ** floor(log10(most) + 1e-9)
    return next(
        round(factor * power, 9) for factor in (5, 2, 1) if factor * power <= most * (1 + 1e-9)
    )


def in_words(metres: float) -> str:
    """A distance [m] in the unit that one would say it in."""
    return f"{metres:g} m" if metres >= 1 else f"{100 * metres:g} cm"
