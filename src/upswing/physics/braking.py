"""Whether the strongest push can still stop a pendulum that swings up through the horizontal (C15).

From the pendulum's own equations, step by step: with full braking all the way up and beyond, does it
come to rest before it passes the horizontal on the other side? Nothing else can stop it if that cannot.
"""

from functools import cache

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


@cache
def highest_stoppable_speed(body: Pendulum) -> float:
    """The speed at the horizontal [rad/s] above which nothing stops the pendulum."""
    return highest_speed_short_of(body, HORIZONTAL)
