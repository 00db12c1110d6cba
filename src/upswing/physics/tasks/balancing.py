"""Balancing: start near upright, reset beyond the horizontal (§4.5)."""

from math import radians

from upswing.physics.tasks import HORIZONTAL, RESETS, Task, start_velocity
from upswing.study.readings import Readings


def create(readings: Readings) -> Task:
    """Start within ±20° of φ = 0; reset likewise whenever |φ| passes 90°."""
    return Task(
        start_angle=radians(20),
        start_velocity=start_velocity(readings),
        critical_angle=HORIZONTAL,
        largest_angle=HORIZONTAL,
        wraps=False,
        rewards_next=readings.reward_state == "next",
        reset=RESETS[readings.reset],
    )
