"""Watkins's Q(λ): an error moves all that led to it, while that was greedy (Sutton and Barto, §7.6).

Traces accumulate. A visit n steps back has a trace of (γλ)ⁿ; those below ``FORGOTTEN`` are dropped, so
that the visits that still have one are a short list.
"""

from math import ceil, log
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from upswing.agents.algorithms import Design, Step, learn_from_of
from upswing.agents.features import locate
from upswing.agents.learners import Array, update, values
from upswing.agents.policy import Rule
from upswing.study import architecture
from upswing.study.values import Share

FORGOTTEN = 1e-6
"""The smallest trace that is kept."""


class Options(architecture.Architecture):
    """How long a visit is remembered."""

    trace: Share = Field(description="The λ by which a trace decays, beside γ.")


class QLambda(NamedTuple):
    """The visits that still have a trace, the newest last but for wrapping round; shape (visits,)."""

    trace: float  # λ
    angle: Array  # φ [rad]
    angular_velocity: Array  # φ̇ [rad/s]
    action: NDArray[np.int64]
    filled: NDArray[np.int64]  # how many visits have a trace, and where the next one goes: (2,)


@learn_from_of(QLambda)
def _learn_from(
    algorithm: QLambda, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    room = len(algorithm.action)
    if step.q[step.action] < max(step.q):  # an exploring action: what led here did not lead to it
        algorithm.filled[0] = 0
    newest = algorithm.filled[1]
    algorithm.angle[newest], algorithm.angular_velocity[newest] = step.angle, step.angular_velocity
    algorithm.action[newest] = step.action
    algorithm.filled[0] = min(algorithm.filled[0] + 1, room)
    algorithm.filled[1] = (newest + 1) % room

    next_value = 0.0 if step.terminal else max(values(learner, step.next_place))
    td_error = step.reward + rule.discount * next_value - step.q[step.action]
    trace = 1.0
    for back in range(algorithm.filled[0]):
        visit = (newest - back) % room
        place = locate(encoder, algorithm.angle[visit], algorithm.angular_velocity[visit])
        update(learner, place, algorithm.action[visit], rule.step_size * td_error * trace)
        trace *= rule.discount * algorithm.trace
    if step.fell:
        algorithm.filled[0] = 0
    return td_error


def create(design: Design) -> QLambda:
    """Q(λ) before its first step."""
    trace = float(design.options["trace"])
    decay = design.discount * trace
    room = 1 if decay == 0 else ceil(log(FORGOTTEN) / log(decay))
    action = np.zeros(room, dtype=np.int64)
    return QLambda(trace, np.zeros(room), np.zeros(room), action, np.zeros(2, dtype=np.int64))
