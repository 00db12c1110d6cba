"""What the pendulum does over a run, in a word: it stands, swings, spins, runs away or hangs."""

from collections.abc import Iterable
from math import atan2, degrees, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.physics.actions import listed
from upswing.study.physical import PendulumOptions

Real = NDArray[np.float64]

COLUMNS = 40
"""Number of stretches that a run is cut into, each of which has one phase or none."""

SHORTEST = 2
"""Number of stretches in a row from which on a phase is named: a twentieth of the run."""

UPRIGHT, HANGING, NEAR_HELD = 20.0, 15.0, 15.0
"""How near upright it stands, how near the lowest point it hangs, how near it is held [°]."""

MOST, HALF = 0.75, 0.5
"""The share of a stretch's steps that makes it one phase; running away swings in first."""

WORDS = {
    "stands": "it stands",
    "runs away": "it runs away (the cart is pushed one way for ever, which holds the rod {held} "
    "from upright)",
    "hangs": "it hangs",
    "spins": "it spins (is fast enough to turn over and over)",
    "swings": "it swings below the top",
}
"""What each phase means (``meaning``), in the order in which they are looked for."""


class Phase(NamedTuple):
    """A phase, at its longest stretch."""

    name: str  # of ``WORDS``
    first: float  # where the stretch begins and ends, as parts of the run
    last: float
    angle: float  # around which [°], −90 to 270; 180 for what swings and spins


def held(body: PendulumOptions) -> tuple[float, float]:
    """Where the strongest pushes to the right and to the left, for ever, hold the rod (eq. 13) [°].

    Both are angles from upright, to the one side and to the other; that of the thesis's is 134°.
    """
    pushes = body.accelerations[-1], -body.accelerations[0]
    right, left = (degrees(pi - atan2(push, body.gravity)) for push in pushes)
    return right, left


def meaning(name: str, bodies: Iterable[PendulumOptions]) -> str:
    """What a phase means where these are the pendulums."""
    angles = {f"{angle:.0f}°" for body in bodies for angle in held(body)}
    return WORDS[name].format(held=listed(sorted(angles, key=lambda one: float(one[:-1])), "or"))


def phases(angle: Real, angular_velocity: Real, when: Real, body: PendulumOptions) -> list[Phase]:
    """The phases of a run of full control that last for at least a twentieth of it.

    Args:
        angle: φ of steps that are spread evenly over the run [°], shape (steps,).
        angular_velocity: φ̇ of them [rad/s].
        when: where in the run each is, from 0 to 1.
        body: what moves.
    """
    column = np.minimum((when * COLUMNS).astype(int), COLUMNS - 1)
    sizes = np.maximum(np.bincount(column, minlength=COLUMNS), 1)

    def share(is_so: NDArray[np.bool_]) -> Real:
        return np.bincount(column, is_so, COLUMNS) / sizes

    turned = np.mod(angle + 90, 360) - 90
    over_the_top = goes_over(turned, angular_velocity, body)
    right, left = held(body)
    lasts: list[tuple[str, float, NDArray[np.bool_]]] = [
        ("stands", 0.0, share(np.abs(turned) <= UPRIGHT) >= MOST),
        *(
            ("runs away", at, share(np.abs(turned - at) <= NEAR_HELD) >= HALF)
            for at in (right, 360 - left)
        ),
        ("hangs", 180.0, share(np.abs(turned - 180) <= HANGING) >= MOST),
        ("spins", 180.0, share(over_the_top) >= MOST),
        ("swings", 180.0, share(~over_the_top) >= MOST),
    ]
    free = np.bincount(column, minlength=COLUMNS) > 0
    found = []
    for name, around, all_of_it in lasts:
        own, free = all_of_it & free, free & ~all_of_it
        first, last = _longest(own)
        if last - first >= SHORTEST:
            found.append(Phase(name, first / COLUMNS, last / COLUMNS, around))
    return found


def goes_over(angle: Real, angular_velocity: Real, body: PendulumOptions) -> NDArray[np.bool_]:
    """Whether a pendulum on a cart at rest would go over the top: its energy is above that upright.

    Args:
        angle: φ [°].
        angular_velocity: φ̇ [rad/s].
        body: the pendulum.
    """
    least = 3 * body.gravity / body.length * (1 - np.cos(np.radians(angle)))
    return np.asarray(angular_velocity**2 > least)


def longest_within(low: Real, high: Real) -> tuple[int, int]:
    """The longest stretch of windows in which a pendulum stands, as [first, last[.

    Args:
        low: the lowest angle in each window [°].
        high: the highest.
    """
    return _longest((low >= -UPRIGHT) & (high <= UPRIGHT))


def _longest(is_so: NDArray[np.bool_]) -> tuple[int, int]:
    """The longest stretch in which something is so, as [first, last[."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], is_so, [False]]).astype(int)))
    if not len(edges):
        return 0, 0
    begins, ends = edges[::2], edges[1::2]
    at = int(np.argmax(ends - begins))
    return int(begins[at]), int(ends[at])
