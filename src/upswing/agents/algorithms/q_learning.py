"""Q-learning (§3.1): one-step updates towards the best next action."""

from math import nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.algorithms import Design, Step, before_choice_of, learn_from_of
from upswing.agents.features import locate
from upswing.agents.learners import Array, update, values
from upswing.agents.policy import Rule

OWNER, OWN, TERMINAL = 0, 1, 2  # R14
HAND_OVERS = {"owner": OWNER, "own": OWN, "terminal": TERMINAL}
NOTHING_OPEN = -1


class QLearning(NamedTuple):
    """Updates that a module left open when it handed over (R14 `own`), by module."""

    hand_over: int
    step: NDArray[np.int64]  # when it was; NOTHING_OPEN
    angle: Array  # φ of the state it was in [rad]
    angular_velocity: Array  # φ̇ [rad/s]
    action: NDArray[np.int64]
    reward: Array  # in R3's unit


@learn_from_of(QLearning)
def _learn_from(
    algorithm: QLearning, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    module = step.place.module
    handed_over = step.next_place.module != module
    if handed_over and algorithm.hand_over == OWN and not step.terminal:
        algorithm.step[module], algorithm.action[module] = step.t, step.action
        algorithm.angle[module] = step.angle
        algorithm.angular_velocity[module] = step.angular_velocity
        algorithm.reward[module] = step.reward
        return nan
    # Q(s, a) ← Q(s, a) + α [r + γ max Q(s′, a′) − Q(s, a)]   (eq. 12; eq. 11 with α = 1)
    if step.terminal or (handed_over and algorithm.hand_over == TERMINAL):
        bootstrap = 0.0
    else:
        next_q = values(learner, step.next_place)
        bootstrap = rule.bootstrap_sign * rule.discount * max(next_q)
    td_error = step.reward + bootstrap - step.q[step.action]
    update(learner, step.place, step.action, rule.step_size * td_error)
    return td_error


@before_choice_of(QLearning)
def _before_choice(
    algorithm: QLearning, encoder: Any, learner: Any, rule: Rule, td_errors: Any, place: Any
) -> None:
    """Do the update that a module left open, now that it is in control again."""
    module = place.module
    when = algorithm.step[module]
    if when == NOTHING_OPEN:
        return
    next_value = max(values(learner, place))
    left = locate(encoder, algorithm.angle[module], algorithm.angular_velocity[module])
    action = algorithm.action[module]
    q = values(learner, left)
    bootstrap = rule.bootstrap_sign * rule.discount * next_value
    td_error = algorithm.reward[module] + bootstrap - q[action]
    update(learner, left, action, rule.step_size * td_error)
    td_errors[when] = td_error / rule.reward_scale
    algorithm.step[module] = NOTHING_OPEN


def create(design: Design) -> QLearning:
    """Q-learning with no update left open."""
    step, action = (np.full(design.encoder.modules, NOTHING_OPEN, dtype=np.int64) for _ in range(2))
    angle, angular_velocity, reward = (np.zeros(design.encoder.modules) for _ in range(3))
    hand_over = HAND_OVERS[design.readings.hand_over]
    return QLearning(hand_over, step, angle, angular_velocity, action, reward)
