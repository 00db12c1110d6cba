"""Full control: start at any angle; never reset (§4.3, §4.6)."""

from math import inf, pi

from upswing.physics.tasks import RESETS, Task, start_velocity
from upswing.study.readings import Readings


def create(readings: Readings) -> Task:
    """Start at any angle, swing up and balance."""
    return Task(
        start_angle=pi,
        start_velocity=start_velocity(readings),
        critical_angle=inf,
        largest_angle=pi,
        wraps=readings.wrap == "wrapped",
        rewards_next=readings.reward_state == "next",
        reset=RESETS[readings.reset],
    )
