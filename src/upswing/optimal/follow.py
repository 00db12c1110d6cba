"""Following a policy with the true step: with exploring and without, measured as the study's runs."""

from typing import Any, NamedTuple

import numpy as np

from upswing.agents.policy import explored_action, explores
from upswing.optimal.policies import act
from upswing.optimal.state_grid import Array, step
from upswing.physics import tasks
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL
from upswing.runs.metrics import UPRIGHT, last_fifth
from upswing.runs.simulation import streams
from upswing.runs.success import SUCCESS
from upswing.study.readings import Readings
from upswing.study.task import kind_of_task

RUN = 1_000_000
"""The length of a run with exploring, as in the study [steps]."""

EPSILON = 0.01
"""The share of random actions, as in the study (§4.5.1)."""


class Followed(NamedTuple):
    """What a run came to; shares and means over its last fifth."""

    upright_share: float
    above_horizontal_share: float
    mean_reward: float  # [rad²]
    first_upright: int | None  # the first step with |φ| ≤ 20°; None if there is none


class Starts(NamedTuple):
    """What came of the fixed starts at rest, without exploring."""

    success_share: float  # of the starts: upright ≥ 90 % of the judged steps
    from_hanging: bool  # whether that from hanging succeeds
    upright_share: float  # of the judged steps of all starts
    mean_reward: float  # of the same [rad²]


def explored(policy: Any, body: Pendulum, seed: int = 0, steps: int = RUN) -> Followed:
    """A run of full control with ε = 0.01, with the start and the draws of the study's run ``seed``."""
    actions, starts, *_ = streams(seed)
    start = tasks.start(tasks.create("full-control", Readings()), starts)
    angles = np.zeros(steps + 1)
    follow(policy, body, EPSILON, actions, *start, angles)
    upright = np.abs(angles[:-1]) <= UPRIGHT
    last = last_fifth(steps)
    return Followed(
        upright_share=float(upright[last:].mean()),
        above_horizontal_share=float((np.abs(angles[last:-1]) <= HORIZONTAL).mean()),
        mean_reward=-float((angles[last + 1 :] ** 2).mean()),
        first_upright=int(upright.argmax()) if upright.any() else None,
    )


def from_starts(policy: Any, body: Pendulum) -> Starts:
    """Full control from every start of the study's greedy evaluation, hanging first, with ε = 0."""
    shares, rewards = [], []
    task = kind_of_task("full-control")
    judged = task.greedy_judged
    for start in task.greedy_starts:
        angles = without_exploring(policy, body, start, 0.0, task.greedy_steps)
        shares.append(float((np.abs(angles[-judged - 1 : -1]) <= UPRIGHT).mean()))
        rewards.append(-float((angles[-judged:] ** 2).mean()))
    succeeded = [share >= SUCCESS for share in shares]
    return Starts(
        success_share=float(np.mean(succeeded)),
        from_hanging=succeeded[0],
        upright_share=float(np.mean(shares)),
        mean_reward=float(np.mean(rewards)),
    )


def without_exploring(
    policy: Any, body: Pendulum, angle: float, angular_velocity: float, steps: int
) -> Array:
    """φ [rad] of each state of a run from φ [rad] and φ̇ [rad/s], the last included: (steps + 1,)."""
    angles = np.zeros(steps + 1)
    follow(policy, body, 0.0, np.random.default_rng(0), angle, angular_velocity, angles)
    return angles


@compiled
def follow(
    policy: Any,
    body: Pendulum,
    epsilon: float,
    actions: np.random.Generator,
    angle: float,
    angular_velocity: float,
    angles: Array,
) -> None:
    """Fill ``angles`` [rad] with the states of a run; one draw a step, used as in ``policy``."""
    angles[0] = angle
    for t in range(1, len(angles)):
        draw = actions.random()
        if explores(draw, epsilon):
            action = explored_action(draw, epsilon, len(body.accelerations))
        else:
            action = act(policy, body, angle, angular_velocity)
        angle, angular_velocity = step(body, angle, angular_velocity, action)
        angles[t] = angle
