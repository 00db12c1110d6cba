"""Tasks: where a run starts, when it is reset, what is rewarded (§4.3–4.6).

A task is a file of this folder with a function ``create`` that makes one under a reading. How its runs
are judged, ordered, tried out and drawn, and options of its own, stand there in a class ``Options``
(``study/task.py`` says what holds without it). Tasks are imported by name, as learners are.
"""

from collections.abc import Mapping
from math import pi, radians
from typing import Any, NamedTuple

import numpy as np

from upswing.physics import track
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum, energy
from upswing.physics.track import Endless, Track, track_of
from upswing.study.loading import load
from upswing.study.physical import StartOptions, TrackOptions
from upswing.study.readings import Readings

HORIZONTAL = pi / 2
"""The critical angle of §4.5, where the pendulum is horizontal [rad]."""


RESET_FALLEN, RESET_TERMINAL, RESET_START = 0, 1, 2  # R7
RESETS = {"fallen": RESET_FALLEN, "terminal": RESET_TERMINAL, "reset": RESET_START}


class Task(NamedTuple):
    """A task under a reading."""

    start_angle: float  # a run starts uniformly in ± this [rad] around ``start_middle``
    start_velocity: float  # … and at an angular velocity uniform in ± this [rad/s] (R8)
    critical_angle: float  # a run is reset when |φ| passes this [rad]; infinite: never
    largest_angle: float  # the largest |φ| that is seen [rad], for a pessimistic first Q (R5)
    wraps: bool  # φ is kept within one turn (R4)
    rewards_next: bool  # the reward is that of s′, not of s (R9)
    reset: int  # what s′ of a fall is (R7)
    velocity_weight: float = 0.0  # beyond the thesis: −w·φ̇² is added to the reward [s²]
    shaping: float = 0.0  # beyond the thesis: the height of the potential of energy [rad²]
    start_middle: float = 0.0  # the middle of the starts [rad]: π to start hanging
    track: Endless | Track = Endless()  # how far the cart can go


RANDOM_START_VELOCITY = 2.0
"""± [rad/s] under R8 `random`: the two velocity tiles around zero, the finest that the grid has."""


def start_velocity(readings: Readings) -> float:
    """Half the range of φ̇ at a start [rad/s] (R8)."""
    return RANDOM_START_VELOCITY if readings.start_velocity == "random" else 0.0


class Plan(NamedTuple):
    """What a task is made from."""

    readings: Readings
    options: Mapping[str, Any]  # as in the configuration; empty where there is none


def create(kind: str, readings: Readings, options: Mapping[str, Any] | None = None) -> Task:
    """A task, by the name of its file in this folder; ``options`` as in the configuration."""
    given = options or {}
    task: Task = load("tasks", kind).create(Plan(readings, given))
    start = StartOptions.model_validate(given.get("start", {}))
    return task._replace(
        velocity_weight=float(given.get("velocity_weight", 0.0)),
        shaping=float(given.get("shaping", 0.0)),
        track=track_of(TrackOptions.model_validate(given.get("track", {}))),
        start_middle=task.start_middle if start.middle is None else radians(start.middle),
        start_angle=task.start_angle if start.within is None else radians(start.within),
        start_velocity=task.start_velocity if start.velocity is None else float(start.velocity),
    )


@compiled
def start(task: Task, starts: np.random.Generator) -> tuple[float, float]:
    """A start state φ [rad], φ̇ [rad/s]: two draws, whatever the task, so that runs stay paired."""
    angle = task.start_middle + task.start_angle * (2.0 * starts.random() - 1.0)
    if task.wraps:
        angle = wrapped(angle)
    angular_velocity = task.start_velocity * (2.0 * starts.random() - 1.0)
    return angle, angular_velocity


@compiled
def fallen(task: Task, angle: float, cart_position: float) -> bool:
    """Whether φ [rad] is beyond the critical angle, or the cart, at x [m], at an end where runs end."""
    return abs(angle) > task.critical_angle or track.ends_run(task.track, cart_position)


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


@compiled
def bonus(
    body: Pendulum,
    task: Task,
    discount: float,
    angle: float,
    angular_velocity: float,
    next_angle: float,
    next_angular_velocity: float,
) -> float:
    """What a learner is told besides −φ² [rad²]: nothing in the thesis's own tasks.

    The velocity (§4.6.3 names it), and γ·Φ(s′) − Φ(s) for a potential Φ, which changes no optimal
    policy (Ng, Harada and Russell, 1999).
    """
    speed = next_angular_velocity if task.rewards_next else angular_velocity
    added = -task.velocity_weight * speed * speed
    if task.shaping != 0.0:
        before = potential(body, task, angle, angular_velocity)
        added += discount * potential(body, task, next_angle, next_angular_velocity) - before
    return added


@compiled
def potential(body: Pendulum, task: Task, angle: float, angular_velocity: float) -> float:
    """Φ [rad²]: zero at the energy of the pendulum at rest upright, −shaping at rest hanging."""
    upright = energy(body, 0.0, 0.0)
    return -task.shaping * abs(energy(body, angle, angular_velocity) - upright) / (2 * abs(upright))
