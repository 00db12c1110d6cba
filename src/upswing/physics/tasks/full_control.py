"""Full control: start at any angle; never reset (§4.3, §4.6)."""

from math import inf, pi

from upswing.physics.tasks import RESETS, Plan, Task, start_velocity


def create(plan: Plan) -> Task:
    """Start at any angle, swing up and balance."""
    readings = plan.readings
    return Task(
        start_angle=pi,
        start_velocity=start_velocity(readings),
        critical_angle=inf,
        largest_angle=pi,
        wraps=readings.wrap == "wrapped",
        rewards_next=readings.reward_state == "next",
        reset=RESETS[readings.reset],
    )
