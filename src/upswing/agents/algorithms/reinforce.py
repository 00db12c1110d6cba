"""REINFORCE with a baseline (Williams 1992; §3.3): the return moves the policy, without bootstrapping.

A step learns once its return is complete: after a fall, or when what is still to come weighs nothing.
The baseline V(s) is learned from the same returns. The textbook's factor γᵗ is left out, as is usual.
"""

from math import nan
from typing import Any, ClassVar, NamedTuple

from upswing.agents.algorithms import Design, Step, learn_from_of
from upswing.agents.features import locate
from upswing.agents.learners import state_value, update
from upswing.agents.policy import Rule
from upswing.agents.returns import Waiting, is_complete, nothing_waits, remember, take_oldest
from upswing.study import architecture


class Options(architecture.Architecture):
    """It goes with a learner that holds a policy."""

    improves: ClassVar[architecture.Content] = "policy"


class Reinforce(NamedTuple):
    """The steps that wait for their return."""

    waiting: Waiting


@learn_from_of(Reinforce)
def _learn_from(
    algorithm: Reinforce, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    remember(algorithm.waiting, step)
    td_errors[step.t] = nan
    while is_complete(algorithm.waiting, step.fell):
        visit = take_oldest(algorithm.waiting, rule.discount, step.t)
        place = locate(encoder, visit.angle, visit.angular_velocity)
        error = visit.return_ - state_value(learner, place)
        update(learner, place, visit.action, rule.step_size * error)
        td_errors[visit.t] = error / rule.reward_scale
    own_error: float = td_errors[step.t] * rule.reward_scale
    return own_error


def create(design: Design) -> Reinforce:
    """REINFORCE before its first step."""
    return Reinforce(nothing_waits(design.discount))
