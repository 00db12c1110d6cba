"""Experience replay: decisions that are remembered, to learn from again (Lin 1992; Mnih et al. 2015).

A decision may be held for several steps: its reward is r₁ + γ r₂ + … and its discount γᵏ.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Point
from upswing.agents.learners import Array
from upswing.agents.learners.backpropagation.dense import INPUTS, inputs
from upswing.physics.jit import compiled


class Replay(NamedTuple):
    """Decisions, the latest over the oldest; and in ``open`` the one that is still going on."""

    states: Array  # inputs of s: (capacity, INPUTS)
    actions: NDArray[np.int64]  # a
    rewards: Array  # r₁ + γ r₂ + …, in R3's unit
    next_states: Array  # inputs of s′: (capacity, INPUTS)
    discounts: Array  # γᵏ; 0 where nothing follows
    stored: NDArray[np.int64]  # (1,): how many there have been
    open: Array  # inputs of s, rewards so far, γᵏ so far: (INPUTS + 2,)


@compiled
def begin(replay: Replay, point: Point) -> None:
    """A decision is taken at ``point``."""
    now = replay.open
    now[0], now[1], now[2] = inputs(point)
    now[INPUTS], now[INPUTS + 1] = 0.0, 1.0


@compiled
def collect(replay: Replay, amount: float, discount: float) -> None:
    """One step of the decision is over: r in R3's unit, and γ."""
    now = replay.open
    now[INPUTS] += now[INPUTS + 1] * amount
    now[INPUTS + 1] *= discount


@compiled
def end(replay: Replay, action: int, point: Point, terminal: bool) -> None:
    """The decision for ``action`` led to ``point``: remember it."""
    row = replay.stored[0] % replay.actions.shape[0]
    for i in range(INPUTS):
        replay.states[row, i] = replay.open[i]
    replay.actions[row] = action
    replay.rewards[row] = replay.open[INPUTS]
    after = replay.next_states[row]
    after[0], after[1], after[2] = inputs(point)
    replay.discounts[row] = 0.0 if terminal else replay.open[INPUTS + 1]
    replay.stored[0] += 1


def empty_replay(capacity: int) -> Replay:
    """Room for ``capacity`` decisions."""
    return Replay(
        states=np.zeros((capacity, INPUTS)),
        actions=np.zeros(capacity, dtype=np.int64),
        rewards=np.zeros(capacity),
        next_states=np.zeros((capacity, INPUTS)),
        discounts=np.zeros(capacity),
        stored=np.zeros(1, dtype=np.int64),
        open=np.zeros(INPUTS + 2),
    )


def sample(replay: Replay, size: int, draws: np.random.Generator) -> NDArray[np.int64]:
    """Rows of ``size`` decisions that are remembered, each drawn by itself."""
    remembered = min(int(replay.stored[0]), len(replay.actions))
    return draws.integers(remembered, size=size)
