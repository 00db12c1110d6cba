"""C16: how the largest error of a table shrinks on finite deterministic problems (§3.1.4)."""

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Place
from upswing.agents.learners import Array, update, values
from upswing.agents.learners.table import Table
from upswing.physics.jit import compiled

PROBLEMS = 300
STATES = 12
INTERVALS = 30
"""Number of random problems, of their states, and of the full intervals watched of each."""

DISCOUNT = 0.7
"""γ, as in the rest of the thesis (§4.5.1)."""

ACTIONS = 3
"""As many as the thesis has (§4.4)."""

ROUNDING = 1e-12
"""Errors below this are rounding [unit of the reward]."""

States = NDArray[np.int64]


def contracts(problem: int) -> bool:
    """Whether in every full interval of a problem the largest error shrinks by γ or more.

    In a full interval every state and action is updated once, in an order of its own. The error is
    that against value iteration.
    """
    rng = np.random.default_rng(problem)
    following = rng.integers(STATES, size=(STATES, ACTIONS))
    rewards = rng.normal(size=(STATES, ACTIONS))
    best = best_values(following, rewards, DISCOUNT)
    table = Table(rng.normal(size=(1, STATES, ACTIONS)), (0.0,) * ACTIONS)
    error = np.abs(table.q[0] - best).max()
    for _ in range(INTERVALS):
        full_interval(table, following, rewards, DISCOUNT, rng.permutation(STATES * ACTIONS))
        shrunk = np.abs(table.q[0] - best).max()
        if shrunk > DISCOUNT * error + ROUNDING:
            return False
        error = shrunk
    return True


@compiled
def full_interval(
    table: Table, following: States, rewards: Array, discount: float, order: States
) -> None:
    """Update every state and action once, in ``order``, with α = 1 (eq. 11)."""
    for visit in order:
        state, action = visit // ACTIONS, visit % ACTIONS
        next_q = values(table, Place(0, (following[state, action],)))
        target = rewards[state, action] + discount * max(next_q)
        update(table, Place(0, (state,)), action, target - table.q[0, state, action])


def best_values(following: States, rewards: Array, discount: float) -> Array:
    """Q* by value iteration (eq. 8), to rounding; shapes (states, actions)."""
    q = np.zeros(rewards.shape)
    while True:
        better: Array = rewards + discount * q.max(axis=1)[following]
        if np.abs(better - q).max() <= 1e-15:
            return better
        q = better
