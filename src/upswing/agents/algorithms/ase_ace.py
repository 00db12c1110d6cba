"""How the elements ASE and ACE learn (Barto, Sutton and Anderson 1983, on balancing a pole).

The critic's prediction p turns the reinforcement r into r̂(t) = r(t) + γ p(t) − p(t − 1). The weights of
both elements follow it, as far as their traces say that they took part:

    w(t + 1) = w(t) + α r̂(t) e(t)      e(t + 1) = δ e(t) + (1 − δ) y(t) x(t)
    v(t + 1) = v(t) + β r̂(t) x̄(t)      x̄(t + 1) = λ x̄(t) + (1 − λ) x(t)

Here y is −1 for a push to the left and 1 for one to the right, and x is 1 in the box of the state, else
0. After a failure p(t) is 0, and the traces begin again from 0.
"""

from math import isnan, nan
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np
from pydantic import Field

from upswing.agents.algorithms import Design, Step, learn_from_of
from upswing.agents.learners import Array, state_value
from upswing.agents.policy import Rule
from upswing.study import architecture
from upswing.study.task import Task

CRITIC_STEP = 0.5
"""β."""

SEARCH_TRACE = 0.9
"""δ."""

CRITIC_TRACE = 0.8
"""λ."""


class Options(architecture.Architecture):
    """What it learns from."""

    improves: ClassVar[architecture.Content] = "policy"
    reinforcement: Literal["failure", "reward"] = Field(
        default="failure",
        description="What is learned from: −1 for a fall and else 0, as in 1983, or −φ².",
    )

    def check(self) -> None:
        """It goes with the two elements."""
        if self.learner != "ase-ace":
            raise ValueError("`method: ase-ace` goes with `learner: ase-ace`")

    def check_with(self, task: Task) -> None:
        """There must be something to learn from."""
        falls = task.judged_by == "falls" or task.track.at_end == "falls"
        if self.reinforcement == "failure" and not falls:
            raise ValueError("nothing falls in this task; write `reinforcement: reward`")


class AseAceTraces(NamedTuple):
    """What is remembered of a trial."""

    search: Array  # e: (modules, tiles)
    critic: Array  # x̄: (modules, tiles)
    predicted: Array  # p(t − 1); NaN at the beginning of a trial: (1,)
    failure_alone: bool  # whether r is −1 for a fall and else 0


@learn_from_of(AseAceTraces)
def _learn_from(
    algorithm: AseAceTraces, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    module, box = step.place.module, step.place.tiles[0]
    pushed = 1.0 if step.action == len(step.q) - 1 else -1.0
    algorithm.search[module, box] += (1.0 - SEARCH_TRACE) * pushed
    algorithm.critic[module, box] += 1.0 - CRITIC_TRACE

    before = algorithm.predicted[0]
    if isnan(before):
        before = state_value(learner, step.place)
    now = 0.0 if step.fell else state_value(learner, step.next_place)
    failure = -1.0 if step.fell else 0.0
    reinforcement = failure if algorithm.failure_alone else step.reward
    surprise = reinforcement + rule.discount * now - before  # r̂
    for owner in range(algorithm.search.shape[0]):
        for tile in range(algorithm.search.shape[1]):
            learner.search[owner, tile] += rule.step_size * surprise * algorithm.search[owner, tile]
            learner.critic[owner, tile] += CRITIC_STEP * surprise * algorithm.critic[owner, tile]
            algorithm.search[owner, tile] *= 0.0 if step.fell else SEARCH_TRACE
            algorithm.critic[owner, tile] *= 0.0 if step.fell else CRITIC_TRACE
    algorithm.predicted[0] = nan if step.fell else now
    return float(surprise)


def create(design: Design) -> AseAceTraces:
    """The traces at the beginning of a trial."""
    shape = (design.encoder.modules, design.encoder.tiles)
    failure_alone = design.options["reinforcement"] == "failure"
    return AseAceTraces(np.zeros(shape), np.zeros(shape), np.full(1, nan), failure_alone)
