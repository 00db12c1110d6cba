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
    learn_of,
    nothing_known,
    share,
    value_of,
)


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
    starts_anew = t == experience.begun[t]
    decay = 0.0 if starts_anew else discount * method.trace
    for i in range(len(method.traces)):
        method.traces[i] *= decay
    method.traces[tile] += 1.0
    estimate.updates[tile] += 1
    for i in range(len(method.traces)):
        if starts_anew:
            method.waiting[i] = 0.0
        if method.traces[i] == 0.0:
            continue
        if method.offline:
            method.waiting[i] += td_error * method.traces[i]
        else:
            estimate.values[i] += share(estimate, i) * td_error * method.traces[i]
    if method.offline and after == ENDED:
        for i in range(len(method.traces)):
            if method.waiting[i] != 0.0:
                estimate.values[i] += share(estimate, i) * method.waiting[i]


def create(tiles: int, step_size: float, trace: float, *, offline: bool = False) -> TDLambda:
    """TD(λ) with λ = ``trace``, before its first step."""
    estimate = nothing_known(tiles, step_size)
    return TDLambda(estimate, trace, offline, np.zeros(tiles), np.zeros(tiles))
