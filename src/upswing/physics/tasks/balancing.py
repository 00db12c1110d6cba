"""Balancing: start near upright, reset beyond the horizontal (§4.5)."""

from collections.abc import Mapping
from math import radians
from typing import ClassVar, Literal

from upswing.physics.tasks import HORIZONTAL, RESETS, Plan, Task, start_velocity
from upswing.study import task


class Options(task.Task):
    """A run is judged by its falls; a policy is tried out from starts like those of a run."""

    judged_by: ClassVar[Literal["falls", "upright"]] = "falls"
    order_of_runs: ClassVar[Mapping[str, bool]] = {
        "falls": False, "falls_last_fifth": False, "seed": True,
    }  # fmt: skip
    greedy_starts: ClassVar[tuple[float, ...]] = tuple(
        radians(angle) for angle in range(-20, 21, 5)
    )
    greedy_steps: ClassVar[int] = 2_000
    greedy_judged: ClassVar[int] = 2_000
    angle_limit: ClassVar[int] = 90
    first_measures: ClassVar[tuple[str, ...]] = ("falls", "falls_last_fifth", "upright_share")


def create(plan: Plan) -> Task:
    """Start within ±20° of φ = 0; reset likewise whenever |φ| passes 90°."""
    readings = plan.readings
    return Task(
        start_angle=radians(20),
        start_velocity=start_velocity(readings),
        critical_angle=HORIZONTAL,
        largest_angle=HORIZONTAL,
        wraps=False,
        rewards_next=readings.reward_state == "next",
        reset=RESETS[readings.reset],
    )
