"""Monte Carlo control (§2.4.3): a visit learns from the return that followed it, without bootstrapping.

An episode of balancing ends with a fall. Full control has no episodes, but with the discount γ what
comes after a few steps weighs nothing: a return is taken over so many steps that the rest weighs less
than ``NEGLIGIBLE``. That is every-visit Monte Carlo control with an ε-greedy policy that improves at
every step; with a constant α, or with the average of all returns where the learner is ``decaying``.
"""

from math import ceil, log, nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.algorithms import Design, Step, learn_from_of
from upswing.agents.features import locate
from upswing.agents.learners import Array, update, values
from upswing.agents.policy import Rule
from upswing.physics.jit import compiled

NEGLIGIBLE = 1e-6


class MonteCarlo(NamedTuple):
    """The steps whose return is not yet complete; arrays of shape (steps,), filled round and round."""

    angle: Array  # φ [rad]
    angular_velocity: Array  # φ̇ [rad/s]
    action: NDArray[np.int64]
    reward: Array  # in R3's unit
    waiting: NDArray[np.int64]  # how many steps wait: (1,)


@learn_from_of(MonteCarlo)
def _learn_from(
    algorithm: MonteCarlo, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    room = len(algorithm.action)
    here = step.t % room
    algorithm.angle[here], algorithm.angular_velocity[here] = step.angle, step.angular_velocity
    algorithm.action[here], algorithm.reward[here] = step.action, step.reward
    algorithm.waiting[0] += 1
    td_errors[step.t] = nan
    if step.fell:  # the end of an episode: all returns are complete
        while algorithm.waiting[0] > 0:
            _learn_oldest(algorithm, encoder, learner, rule, td_errors, step.t)
    elif algorithm.waiting[0] == room:
        _learn_oldest(algorithm, encoder, learner, rule, td_errors, step.t)
    own_error: float = td_errors[step.t] * rule.reward_scale
    return own_error


@compiled
def _learn_oldest(
    algorithm: MonteCarlo, encoder: Any, learner: Any, rule: Rule, td_errors: Any, now: int
) -> None:
    """Q(s, a) ← Q(s, a) + α [return − Q(s, a)] for the step that has waited longest."""
    room = len(algorithm.action)
    waiting = algorithm.waiting[0]
    return_ = 0.0
    for back in range(waiting):
        return_ = algorithm.reward[(now - back) % room] + rule.discount * return_
    oldest = now - waiting + 1
    visit = oldest % room
    action = algorithm.action[visit]
    place = locate(encoder, algorithm.angle[visit], algorithm.angular_velocity[visit])
    error = return_ - values(learner, place)[action]
    update(learner, place, action, rule.step_size * error)
    td_errors[oldest] = error / rule.reward_scale
    algorithm.waiting[0] = waiting - 1


def create(design: Design) -> MonteCarlo:
    """Monte Carlo control before its first step."""
    room = 1 if design.discount == 0 else ceil(log(NEGLIGIBLE) / log(design.discount))
    angle, angular_velocity, reward = (np.zeros(room) for _ in range(3))
    action, waiting = np.zeros(room, dtype=np.int64), np.zeros(1, dtype=np.int64)
    return MonteCarlo(angle, angular_velocity, action, reward, waiting)
