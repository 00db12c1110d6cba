"""What an agent from elsewhere is told of a state: in the environments and in the study alike."""

from math import hypot

import numpy as np
from numpy.typing import NDArray

from upswing.physics.elementary import sine_and_cosine
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import ACCELERATIONS

Observation = NDArray[np.float64]
"""cos φ, sin φ, φ̇ [rad/s], shape (3,)."""


def observed(angle: float, angular_velocity: float) -> Observation:
    """The observation of φ [rad] and φ̇ [rad/s], shape (3,)."""
    sine, cosine = sine_and_cosine(angle)
    return np.array([cosine, sine, angular_velocity])


def largest_velocity(body: Pendulum) -> float:
    """What |φ̇| never passes [rad/s]: where friction eats the largest torque there can be (eq. 14–17).

    From below it, one step leads to at most (1 − f_c/J·dt) of it plus f_c/J·dt of it.
    """
    push = max(ACCELERATIONS)
    return body.mass * body.length / 2 * hypot(body.gravity, push) / body.friction
