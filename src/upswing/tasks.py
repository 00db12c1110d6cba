"""The two tasks of §4.3–4.6: where a run starts, when it is reset, what is rewarded."""

from math import inf, pi, radians
from typing import NamedTuple

import numpy as np

from upswing.compiled import compiled
from upswing.readings import Readings

ACCELERATIONS = (-10.0, 0.0, 10.0)
"""What the three actions do to the cart [m/s²] (§4.4)."""

ACTIONS = len(ACCELERATIONS)
HORIZONTAL = pi / 2
"""The critical angle of §4.5, where the pendulum is horizontal [rad]."""


class Task(NamedTuple):
    """A task under a reading."""

    start_angle: float  # a run starts uniformly in ± this [rad]
    start_velocity: float  # … and at an angular velocity uniform in ± this [rad/s] (R8)
    critical_angle: float  # a run is reset when |φ| passes this [rad]; infinite: never
    largest_angle: float  # the largest |φ| that is seen [rad], for a pessimistic first Q (R5)
    wraps: bool  # φ is kept within one turn (R4)
    rewards_next: bool  # the reward is that of s′, not of s (R9)


RANDOM_START_VELOCITY = 2.0
"""± [rad/s] under R8 `random`: the two velocity tiles around zero, the finest the coding tells apart."""


def balancing(readings: Readings) -> Task:
    """Start within ±20° of φ = 0; reset likewise whenever |φ| passes 90° (§4.5)."""
    return Task(
        start_angle=radians(20),
        start_velocity=_start_velocity(readings),
        critical_angle=HORIZONTAL,
        largest_angle=HORIZONTAL,
        wraps=False,
        rewards_next=readings.reward_state == "next",
    )


def full_control(readings: Readings) -> Task:
    """Start at any angle; never reset (§4.3, §4.6)."""
    return Task(
        start_angle=pi,
        start_velocity=_start_velocity(readings),
        critical_angle=inf,
        largest_angle=pi,
        wraps=readings.wrap == "wrapped",
        rewards_next=readings.reward_state == "next",
    )


KINDS = {"balancing": balancing, "full-control": full_control}


def _start_velocity(readings: Readings) -> float:
    return RANDOM_START_VELOCITY if readings.start_velocity == "random" else 0.0


@compiled
def start(task: Task, starts: np.random.Generator) -> tuple[float, float]:
    """A start state φ [rad], φ̇ [rad/s]: two draws, whatever the task, so that runs stay paired."""
    angle = task.start_angle * (2.0 * starts.random() - 1.0)
    angular_velocity = task.start_velocity * (2.0 * starts.random() - 1.0)
    return angle, angular_velocity


@compiled
def fallen(task: Task, angle: float) -> bool:
    """Whether φ [rad] is beyond the critical angle."""
    return abs(angle) > task.critical_angle


@compiled
def wrapped(angle: float) -> float:
    """φ [rad] within one turn, −π ≤ φ < π; at most one turn off, as after a single step."""
    if angle >= pi:
        return angle - 2 * pi
    if angle < -pi:
        return angle + 2 * pi
    return angle


@compiled
def reward(angle: float) -> float:
    """−φ² [rad²] (§4.4)."""
    return -angle * angle
