"""Returns: steps whose return is not yet complete, for algorithms that learn without bootstrapping.

An episode of balancing ends with a fall. Full control has no episodes, but with the discount γ what
comes after a few steps weighs nothing: a return is taken over so many steps that the rest weighs less
than ``NEGLIGIBLE``.
"""

from math import ceil, log
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.algorithms import Step
from upswing.agents.learners import Array
from upswing.physics.jit import compiled

NEGLIGIBLE = 1e-6


class Waiting(NamedTuple):
    """The steps whose return is not yet complete; arrays of shape (steps,), filled round and round."""

    angle: Array  # φ [rad]
    angular_velocity: Array  # φ̇ [rad/s]
    action: NDArray[np.int64]
    reward: Array  # in R3's unit
    waiting: NDArray[np.int64]  # how many steps wait: (1,)


class Visit(NamedTuple):
    """A step with the return that followed it."""

    t: int
    angle: float  # φ [rad]
    angular_velocity: float  # φ̇ [rad/s]
    action: int
    return_: float  # in R3's unit


@compiled
def remember(steps: Waiting, step: Step) -> None:
    """Let ``step`` wait for its return."""
    here = step.t % len(steps.action)
    steps.angle[here], steps.angular_velocity[here] = step.angle, step.angular_velocity
    steps.action[here], steps.reward[here] = step.action, step.reward
    steps.waiting[0] += 1


@compiled
def is_complete(steps: Waiting, fell: bool) -> bool:
    """Whether the step that has waited longest has its return; after a fall, all that wait have it."""
    return steps.waiting[0] == len(steps.action) or (fell and steps.waiting[0] > 0)


@compiled
def take_oldest(steps: Waiting, discount: float, now: int) -> Visit:
    """The step that has waited longest, at step ``now``; it waits no more."""
    room = len(steps.action)
    count = steps.waiting[0]
    return_ = 0.0
    for back in range(count):
        return_ = steps.reward[(now - back) % room] + discount * return_
    oldest = now - count + 1
    here = oldest % room
    steps.waiting[0] = count - 1
    return Visit(
        oldest, steps.angle[here], steps.angular_velocity[here], steps.action[here], return_
    )


def nothing_waits(discount: float) -> Waiting:
    """Room for the steps that a return with this discount is taken over."""
    room = 1 if discount == 0 else ceil(log(NEGLIGIBLE) / log(discount))
    angle, angular_velocity, reward = (np.zeros(room) for _ in range(3))
    action, waiting = np.zeros(room, dtype=np.int64), np.zeros(1, dtype=np.int64)
    return Waiting(angle, angular_velocity, action, reward, waiting)
