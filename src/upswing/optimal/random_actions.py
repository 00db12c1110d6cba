"""What acting at random is worth in every state when a fall ends the episode: its V on a grid."""

from math import pi

import numpy as np
from numpy.typing import NDArray

from upswing.optimal.state_grid import (
    Array,
    Grid,
    Successors,
    between,
    interpolate,
    points,
    successors,
)
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL

TOLERANCE = 1e-5
"""V on the grid is the fixed point of its sweeps to this [rad²]."""


def values_at_random(body: Pendulum, grid: Grid, discount: float) -> Array:
    """V of random actions, (points,) [rad²]; 0 where the pendulum has fallen already.

    The horizontal must lie on points of the grid (4 divides its rows): V jumps there, and no value is
    taken from beyond it.

    Args:
        body: the pendulum.
        grid: its points.
        discount: γ, below 1.
    """
    if grid.rows % 4:
        raise ValueError(f"a grid of {grid.rows} rows has no points at the horizontal")
    ways, angles = successors(body, grid), points(grid)[0]
    upright = np.flatnonzero(np.abs(angles) < HORIZONTAL + pi / grid.rows).astype(np.int64)
    values, better = np.zeros(len(angles)), np.zeros(len(angles))
    while True:
        change = _sweep(grid.columns, ways, discount, upright, values, better)
        values, better = better, values
        if change * discount <= TOLERANCE * (1 - discount):
            return values


def at_states(grid: Grid, values: Array, angles: Array, velocities: Array) -> Array:
    """The values of a grid in states φ [rad], φ̇ [rad/s]; all of shape (states,)."""
    found = np.zeros(len(angles))
    _look_up(grid, values, angles, velocities, found)
    return found


@compiled
def _sweep(
    columns: int,
    ways: Successors,
    discount: float,
    upright: NDArray[np.int64],
    values: Array,
    better: Array,
) -> float:
    """V(s) ← the mean over the actions of R + γ V(s′); the largest change."""
    largest, actions = 0.0, ways.corner.shape[1]
    for point in upright:
        total = 0.0
        for action in range(actions):
            angle = ways.angle[point, action]
            total -= angle * angle
            if abs(angle) <= HORIZONTAL:
                total += discount * between(
                    columns,
                    values,
                    ways.corner[point, action],
                    ways.up[point, action],
                    ways.across[point, action],
                )
        better[point] = total / actions
        largest = max(largest, abs(better[point] - values[point]))
    return largest


@compiled
def _look_up(grid: Grid, values: Array, angles: Array, velocities: Array, found: Array) -> None:
    for state in range(len(angles)):
        found[state] = interpolate(grid, values, angles[state], velocities[state])
