"""Whether the strongest push can still stop a pendulum that swings up through the horizontal (C15).

From the pendulum's own equations, step by step: with full braking all the way up and beyond, does it
come to rest before it passes the horizontal on the other side? Nothing else can stop it if that cannot.
"""

from functools import cache
from typing import NamedTuple

from upswing.physics import pendulum
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL

FAST = 100.0
"""No pendulum of the thesis is faster [rad/s]; for another one it is doubled until it is so."""


@compiled
def passes(body: Pendulum, angular_velocity: float, limit: float) -> bool:
    """Whether a pendulum at −90° with φ̇ > 0 [rad/s] passes ``limit`` [rad] in spite of full braking."""
    angle = -HORIZONTAL
    while angular_velocity > 0:
        # Above the horizontal the cosine is positive: this acceleration turns against φ̇ > 0.
        braking = body.accelerations[0 if body.orientation > 0 else -1]
        angle, angular_velocity = pendulum.step(body, angle, angular_velocity, braking)
        if angle > limit:
            return True
    return False


def highest_speed_short_of(body: Pendulum, limit: float) -> float:
    """The highest φ̇ at −90° [rad/s] that full braking stops before ``limit`` [rad]; to 10⁻⁹."""
    low, high = 0.0, FAST
    while not passes(body, high, limit):
        low, high = high, 2 * high
    while high - low > 1e-9:
        middle = (low + high) / 2
        low, high = (low, middle) if passes(body, middle, limit) else (middle, high)
    return low


class Stoppable(NamedTuple):
    """The speeds at the horizontal above which nothing stops the pendulum, by the side it comes from."""

    rising: float  # |φ̇| of an arrival with φ̇ > 0, from −90° [rad/s]
    falling: float  # |φ̇| of an arrival with φ̇ < 0, from +90° [rad/s]


@cache
def stoppable_speeds(body: Pendulum) -> Stoppable:
    """Up to which speed the push against it stops the pendulum, from either side [rad/s]."""
    one, other = (highest_speed_short_of(each, HORIZONTAL) for each in (body, mirrored(body)))
    return Stoppable(one, other)


def highest_stoppable_speed(body: Pendulum) -> float:
    """The speed at the horizontal [rad/s] up to which it can be stopped, whatever side it comes from."""
    return min(stoppable_speeds(body))


def mirrored(body: Pendulum) -> Pendulum:
    """The same pendulum seen from behind: left is right."""
    pushes = tuple(-push for push in reversed(body.accelerations))
    return body if pushes == tuple(body.accelerations) else body._replace(accelerations=pushes)
