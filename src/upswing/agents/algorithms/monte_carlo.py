"""Monte Carlo control (§2.4.3): a visit learns from the return that followed it, without bootstrapping.

That is every-visit Monte Carlo control with an ε-greedy policy that improves at every step; with a
constant α, or with the average of all returns where the learner is ``decaying``.
"""

from math import nan
from typing import Any, NamedTuple

from upswing.agents.algorithms import Design, Step, learn_from_of
from upswing.agents.features import locate
from upswing.agents.learners import update, values
from upswing.agents.policy import Rule
from upswing.agents.returns import Waiting, is_complete, nothing_waits, remember, take_oldest


class MonteCarlo(NamedTuple):
    """The steps that wait for their return."""

    waiting: Waiting


@learn_from_of(MonteCarlo)
def _learn_from(
    algorithm: MonteCarlo, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    remember(algorithm.waiting, step)
    td_errors[step.t] = nan
    while is_complete(algorithm.waiting, step.fell):
        # Q(s, a) ← Q(s, a) + α [return − Q(s, a)]
        visit = take_oldest(algorithm.waiting, rule.discount, step.t)
        place = locate(encoder, visit.angle, visit.angular_velocity)
        error = visit.return_ - values(learner, place)[visit.action]
        update(learner, place, visit.action, rule.step_size * error)
        td_errors[visit.t] = error / rule.reward_scale
    own_error: float = td_errors[step.t] * rule.reward_scale
    return own_error


def create(design: Design) -> MonteCarlo:
    """Monte Carlo control before its first step."""
    return MonteCarlo(nothing_waits(design.discount))
