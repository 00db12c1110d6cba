"""Value iteration: the best discounted return on full control, and the policy that is greedy for it."""

from collections.abc import Callable
from math import inf
from typing import NamedTuple

import numpy as np

from upswing.optimal.policies import act_of
from upswing.optimal.state_grid import Array, Grid, Successors, between, interpolate, step
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import reward

TOLERANCE = 1e-6
"""V is known to this [rad²]."""


class Optimal(NamedTuple):
    """The policy that looks one true step ahead and then believes in V."""

    grid: Grid
    values: Array  # V*, (points,) [rad²]
    discount: float  # γ


@compiled
def promised(
    policy: Optimal, body: Pendulum, angle: float, angular_velocity: float, action: int
) -> float:
    """Q(s, a) [rad²] at φ [rad] and φ̇ [rad/s], one true step ahead (eq. 8)."""
    next_angle, next_velocity = step(body, angle, angular_velocity, action)
    value = interpolate(policy.grid, policy.values, next_angle, next_velocity)
    return reward(next_angle) + policy.discount * value


@act_of(Optimal)
def _act(policy: Optimal, body: Pendulum, angle: float, angular_velocity: float) -> int:
    best, action = -inf, 0
    # Of equally good actions the first, as in the study (R6).
    for candidate in range(len(body.accelerations)):
        value = promised(policy, body, angle, angular_velocity, candidate)
        if value > best:
            best, action = value, candidate
    return action


def optimal_values(
    grid: Grid,
    ways: Successors,
    discount: float,
    begun: Array | None = None,
    swept: Callable[[Array], None] = lambda _: None,
) -> Array:
    """V* of every point (eq. 8), shape (points,), to ``TOLERANCE`` [rad²]; never reset.

    Every sweep says between which bounds V* lies: after one that changed no value by less than a
    and none by more than b, those that follow add between a and b times γ/(1 − γ) (MacQueen 1966).
    So it ends long before the values stand still: with γ near 1 they soon rise or sink all together.

    Args:
        grid: its points.
        ways: where the actions lead from them.
        discount: γ, below 1.
        begun: values to begin with; the better the faster.
        swept: is given the values after every sweep; they change with the next.
    """
    values = np.zeros(len(ways.corner)) if begun is None else begun.copy()
    better, rewards = np.zeros_like(values), -(ways.angle**2)
    further = discount / (1 - discount)
    while True:
        low, high = _sweep(grid.columns, ways, rewards, discount, values, better)
        values, better = better, values
        if further * (high - low) <= 2 * TOLERANCE:
            found: Array = values + further * (low + high) / 2
            swept(found)
            return found
        swept(values)


@compiled
def _sweep(
    columns: int, ways: Successors, rewards: Array, discount: float, values: Array, better: Array
) -> tuple[float, float]:
    """One full backup of every point, ``values`` into ``better``; the least and the largest change."""
    low, high = inf, -inf
    for point in range(len(values)):
        best = -inf
        for action in range(ways.corner.shape[1]):
            value = between(
                columns,
                values,
                ways.corner[point, action],
                ways.up[point, action],
                ways.across[point, action],
            )
            best = max(best, rewards[point, action] + discount * value)
        better[point] = best
        low = min(low, best - values[point])
        high = max(high, best - values[point])
    return low, high
