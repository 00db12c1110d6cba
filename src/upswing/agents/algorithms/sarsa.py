"""Sarsa: one-step updates towards the action that is really taken next (Sutton and Barto 1998, §6.4)."""

from math import nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.algorithms import Design, Step, after_choice_of, learn_from_of
from upswing.agents.features import locate
from upswing.agents.learners import Array, update, values
from upswing.agents.policy import Rule

NOTHING = -1


class Sarsa(NamedTuple):
    """The last step, which waits for the next action; arrays of shape (1,)."""

    step: NDArray[np.int64]  # when it was; NOTHING
    angle: Array  # φ [rad]
    angular_velocity: Array  # φ̇ [rad/s]
    action: NDArray[np.int64]
    reward: Array  # in R3's unit


@after_choice_of(Sarsa)
def _after_choice(
    algorithm: Sarsa,
    encoder: Any,
    learner: Any,
    rule: Rule,
    td_errors: Any,
    place: Any,
    action: int,
) -> None:
    when = algorithm.step[0]
    if when == NOTHING:
        return
    # Q(s, a) ← Q(s, a) + α [r + γ Q(s′, a′) − Q(s, a)]
    before = locate(encoder, algorithm.angle[0], algorithm.angular_velocity[0])
    next_q = values(learner, place)[action]
    td_error = (
        algorithm.reward[0] + rule.discount * next_q - values(learner, before)[algorithm.action[0]]
    )
    update(learner, before, algorithm.action[0], rule.step_size * td_error)
    td_errors[when] = td_error / rule.reward_scale
    algorithm.step[0] = NOTHING


@learn_from_of(Sarsa)
def _learn_from(
    algorithm: Sarsa, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    if step.fell:
        # No action follows in a fallen state: R7 says what it is worth, and there is no exploring in it.
        next_value = 0.0 if step.terminal else max(values(learner, step.next_place))
        # The step before has been learned from since the action was chosen, perhaps in this very tile.
        q = values(learner, step.place)[step.action]
        td_error = step.reward + rule.discount * next_value - q
        update(learner, step.place, step.action, rule.step_size * td_error)
        return td_error
    algorithm.step[0], algorithm.action[0], algorithm.reward[0] = step.t, step.action, step.reward
    algorithm.angle[0], algorithm.angular_velocity[0] = step.angle, step.angular_velocity
    return nan


def create(design: Design) -> Sarsa:
    """Sarsa before its first step."""
    step, action = (np.full(1, NOTHING, dtype=np.int64) for _ in range(2))
    return Sarsa(step, np.zeros(1), np.zeros(1), action, np.zeros(1))
