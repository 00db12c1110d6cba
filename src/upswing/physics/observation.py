"""What an agent from elsewhere is told of a state: in the environments and in the study alike."""

from math import expm1, hypot, inf, sqrt

import numpy as np
from numpy.typing import NDArray

from upswing.physics.elementary import sine_and_cosine
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import Task

Observation = NDArray[np.float64]
"""cos φ, sin φ, φ̇ [rad/s], shape (3,)."""


def observed(angle: float, angular_velocity: float) -> Observation:
    """The observation of φ [rad] and φ̇ [rad/s], shape (3,)."""
    sine, cosine = sine_and_cosine(angle)
    return np.array([cosine, sine, angular_velocity])


def largest_velocity(body: Pendulum, task: Task) -> float:
    """What |φ̇| never passes [rad/s], from a start up to ``largest_start``; infinite without friction."""
    return largest_start(body, task) + _largest_jerk(body, task)


def largest_start(body: Pendulum, task: Task) -> float:
    """The largest |φ̇| of a start [rad/s]; without ends of a track, it is never passed.

    Friction eats the largest torque there can be (eq. 14–17) at this speed. From below it, one step
    leads to at most (1 − f_c/J·dt) of it plus f_c/J·dt of it. A task may start faster.
    """
    if body.friction == 0:
        return inf
    torque = body.mass * body.length / 2 * hypot(body.gravity, _push(body))
    return max(torque / body.friction, task.start_velocity)


def _largest_jerk(body: Pendulum, task: Task) -> float:
    """The most that a cart adds to |φ̇| by stopping at the ends of its track, however often [rad/s].

    From one end to the other it gains at most v, in no less than T = v/a. What it loses within a time T
    so is at most what it can gain in 2·T; a jerk is 3/(2l) of that (``pendulum.jerk``), and friction
    leaves e^(−T·f_c/J) of it after a time T. So the sum of all is a geometric series.
    """
    if task.track.limit == inf:
        return 0.0
    push = _push(body)
    fastest = sqrt(4 * push * task.track.limit) + push * body.time_step
    inertia = body.mass * body.length**2 / 3
    fading = -expm1(-fastest / push * body.friction / inertia)
    return 3 / (2 * body.length) * 2 * fastest / fading if fading else inf


def _push(body: Pendulum) -> float:
    return max(map(abs, body.accelerations))
