"""One-step actor-critic (§3.3): the critic's TD error moves the critic and the policy alike.

δ = r + γ V(s′) − V(s) asks how much better things went than the critic thought. The factor γᵗ of the
textbook is left out, as is usual: it would make later steps of an episode count for nothing.
"""

from typing import Any, ClassVar, NamedTuple

from upswing.agents.algorithms import Design, Step, learn_from_of
from upswing.agents.learners import state_value, update
from upswing.agents.policy import Rule
from upswing.study import architecture


class Options(architecture.Architecture):
    """It goes with a learner that holds a policy."""

    improves: ClassVar[architecture.Content] = "policy"


class ActorCritic(NamedTuple):
    """Nothing is remembered."""


@learn_from_of(ActorCritic)
def _learn_from(
    algorithm: ActorCritic, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    next_value = 0.0 if step.terminal else state_value(learner, step.next_place)
    td_error = step.reward + rule.discount * next_value - state_value(learner, step.place)
    update(learner, step.place, step.action, rule.step_size * td_error)
    return float(td_error)


def create(design: Design) -> ActorCritic:
    """An actor-critic before its first step."""
    return ActorCritic()
