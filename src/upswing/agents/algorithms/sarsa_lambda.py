"""Sarsa(λ) with eligibility traces over weights: TD(λ) as TD-Gammon learned by it (§3.2.2).

Every weight has a trace, which says how much it took part in the values of the actions that were taken:

    e ← γ λ e + ∇Q(s, a)      w ← w + α [r + γ Q(s′, a′) − Q(s, a)] e

So each visit takes part with the gradient that there was at the time, where ``q-lambda`` goes back to
the state and asks for today's. Traces begin from zero with each episode. TD-Gammon learns V of the
positions that it moves to, since it knows its game; here an action's value takes that place.
"""

from math import nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from upswing.agents.algorithms import Design, Step, after_choice_of, learn_from_of
from upswing.agents.features import locate
from upswing.agents.learners import Array, values
from upswing.agents.policy import Rule
from upswing.agents.traces import add_gradient, forget_kept, nothing_like, weights
from upswing.physics.jit import compiled
from upswing.study import architecture
from upswing.study.values import Share

NOTHING = -1


class Options(architecture.Architecture):
    """How long it is remembered that a weight took part."""

    trace: Share = Field(description="The λ by which a trace decays, beside γ.")

    def check(self) -> None:
        """Its learner has weights that a state's value can be derived by."""
        if self.learner == "dqn":
            raise ValueError("dqn has an algorithm of its own; leave `method` out")
        if self.learner != "networks" and self.gives in ("tile", "tiles"):
            raise ValueError(
                "traces over weights go with networks, or with a linear function; for "
                f"{self.learner} on tiles write `method: q-lambda`"
            )
        if self.learner == "networks" and len(getattr(self, "hidden", ())) > 1:
            raise ValueError("traces over weights go with networks of one hidden layer")


class SarsaLambda(NamedTuple):
    """The traces, and the last step, which waits for the next action; the latter of shape (1,)."""

    trace: float  # λ
    traces: Any  # e, as a learner of the same kind
    eligibility: tuple[Array, ...]  # the same memory, each as (weights,)
    weights: tuple[Array, ...]  # w, likewise
    step: NDArray[np.int64]  # when it was; NOTHING
    angle: Array  # φ [rad]
    angular_velocity: Array  # φ̇ [rad/s]
    action: NDArray[np.int64]
    reward: Array  # in R3's unit


@compiled
def follow(algorithm: SarsaLambda, learner: Any, error: float) -> None:
    """Move every weight by its share of the error signal α·δ."""
    for part in range(len(algorithm.weights)):
        w, e = algorithm.weights[part], algorithm.eligibility[part]
        for i in range(w.shape[0]):
            w[i] += error * e[i]
    forget_kept(learner)


@compiled
def fade(algorithm: SarsaLambda, factor: float) -> None:
    """Let every trace become so much smaller."""
    for part in range(len(algorithm.eligibility)):
        e = algorithm.eligibility[part]
        for i in range(e.shape[0]):
            e[i] *= factor


@after_choice_of(SarsaLambda)
def _after_choice(
    algorithm: SarsaLambda,
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
    before = locate(encoder, algorithm.angle[0], algorithm.angular_velocity[0])
    taken = algorithm.action[0]
    next_value = values(learner, place)[action]
    td_error = algorithm.reward[0] + rule.discount * next_value - values(learner, before)[taken]
    fade(algorithm, rule.discount * algorithm.trace)
    add_gradient(learner, algorithm.traces, before, taken, 1.0)
    follow(algorithm, learner, rule.step_size * td_error)
    td_errors[when] = td_error / rule.reward_scale
    algorithm.step[0] = NOTHING


@learn_from_of(SarsaLambda)
def _learn_from(
    algorithm: SarsaLambda, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    if step.fell:
        # As in sarsa.py: no action follows in a fallen state.
        next_value = 0.0 if step.terminal else max(values(learner, step.next_place))
        q = values(learner, step.place)[step.action]
        td_error = step.reward + rule.discount * next_value - q
        fade(algorithm, rule.discount * algorithm.trace)
        add_gradient(learner, algorithm.traces, step.place, step.action, 1.0)
        follow(algorithm, learner, rule.step_size * td_error)
        fade(algorithm, 0.0)
        return td_error
    algorithm.step[0], algorithm.action[0], algorithm.reward[0] = step.t, step.action, step.reward
    algorithm.angle[0], algorithm.angular_velocity[0] = step.angle, step.angular_velocity
    return nan


def create(design: Design) -> SarsaLambda:
    """Sarsa(λ) before its first step: every trace is zero."""
    traces = nothing_like(design.learner)
    step, action = (np.full(1, NOTHING, dtype=np.int64) for _ in range(2))
    return SarsaLambda(
        float(design.options["trace"]), traces, weights(traces), weights(design.learner),
        step, np.zeros(1), np.zeros(1), action, np.zeros(1),
    )  # fmt: skip
