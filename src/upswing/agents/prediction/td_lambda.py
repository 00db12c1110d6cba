"""TD(λ): the error of a step moves all states of the episode so far, those long ago the less.

A state's trace says how much: it grows by 1 with each visit and decays by γλ with each step (Sutton and
Barto, §7.3). With λ = 0 it is TD(0). With λ = 1, and changes that wait for the end of the episode
(*offline*), it is every-visit Monte Carlo.
"""

from typing import NamedTuple

import numpy as np

from upswing.agents.prediction import (
    ENDED,
    Array,
    Estimate,
    Experience,
    StepSize,
    learn_of,
    nothing_known,
    share,
    value_of,
)
from upswing.physics.jit import compiled


class TDLambda(NamedTuple):
    """Temporal difference learning with accumulating traces."""

    estimate: Estimate
    trace: float  # λ
    offline: bool  # whether V changes only when an episode ends
    traces: Array  # e, (tiles,)
    waiting: Array  # the sum of δ e so far in this episode, (tiles,) [rad²]; used offline


@learn_of(TDLambda)
def _learn(method: TDLambda, experience: Experience, discount: float, t: int) -> None:
    """δ = r + γ V(s′) − V(s); then V(i) ← V(i) + α δ e(i) for every tile i."""
    estimate, tile, after = method.estimate, experience.tile[t], experience.after[t]
    td_error = experience.reward[t] + discount * value_of(estimate, after) - estimate.values[tile]
    decay = 0.0 if t == experience.begun[t] else discount * method.trace
    for i in range(len(method.traces)):
        method.traces[i] *= decay
    method.traces[tile] += 1.0
    estimate.updates[tile] += 1
    for i in range(len(method.traces)):
        if method.traces[i] != 0.0 or method.waiting[i] != 0.0:
            _move(method, i, td_error * method.traces[i], after == ENDED)


@compiled
def _move(method: TDLambda, tile: int, moved: float, at_end: bool) -> None:
    """Move V of a tile with the step size of its latest visit; offline, once the episode is over."""
    if method.offline:
        method.waiting[tile] += moved
        if not at_end:
            return
        moved = method.waiting[tile]
        method.waiting[tile] = 0.0
    step_size = share(method.estimate.step_size, method.estimate.updates[tile] - 1)
    method.estimate.values[tile] += step_size * moved


def create(tiles: int, step_size: StepSize, trace: float, *, offline: bool = False) -> TDLambda:
    """TD(λ) with λ = ``trace``, before its first step."""
    estimate = nothing_known(tiles, step_size)
    return TDLambda(estimate, trace, offline, np.zeros(tiles), np.zeros(tiles))
