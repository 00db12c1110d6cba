"""A grid over (φ, φ̇), what stands between its points, and where a step leads from each of them."""

from math import floor, pi
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.physics import pendulum, tasks
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum

Array = NDArray[np.float64]

VELOCITY_LIMIT = 25.0
"""The grid reaches over ± this [rad/s]. A pendulum that falls from upright without help gets to 17, one
that can still be caught has at most 20.3 at the horizontal; beyond the limit the edge serves."""


class Grid(NamedTuple):
    """Points over the whole circle and ± a limit; point (i, j) has the index i · columns + j."""

    rows: int  # points of φ over one turn, from −π; the first follows upon the last
    columns: int  # points of φ̇, both ends included
    limit: float = VELOCITY_LIMIT  # [rad/s]

    @property
    def name(self) -> str:
        """As it is called in a table: ``360×401``."""
        return f"{self.rows}×{self.columns}"


class Successors(NamedTuple):
    """Where each action leads from each point; every array has shape (points, actions)."""

    angle: Array  # φ of s′ [rad], within one turn
    corner: NDArray[np.int32]  # the point below s′ in both coordinates
    up: Array  # how far s′ is from it towards the next φ, 0 to 1
    across: Array  # … and towards the next φ̇, 0 to 1


def points(grid: Grid) -> tuple[Array, Array]:
    """φ [rad] and φ̇ [rad/s] of every point, each of shape (points,)."""
    angles = -pi + 2 * pi / grid.rows * np.arange(grid.rows)
    velocities = np.linspace(-grid.limit, grid.limit, grid.columns)
    return np.repeat(angles, grid.columns), np.tile(velocities, grid.rows)


def successors(body: Pendulum, grid: Grid) -> Successors:
    """What ``pendulum.step`` does with every point."""
    angles, velocities = points(grid)
    shape = (len(angles), len(body.accelerations))
    found = Successors(
        np.zeros(shape), np.zeros(shape, dtype=np.int32), np.zeros(shape), np.zeros(shape)
    )
    _fill(body, grid, angles, velocities, found)
    return found


def refined(coarse: Grid, values: Array, fine: Grid) -> Array:
    """The values of a coarse grid at the points of a finer one, shape (points of the finer,)."""
    refined = np.zeros(fine.rows * fine.columns)
    _interpolate_all(coarse, values, *points(fine), refined)
    return refined


@compiled
def place(grid: Grid, angle: float, angular_velocity: float) -> tuple[int, float, float]:
    """The corner of the cell of φ [rad] in ±π and φ̇ [rad/s], and how far they are into it."""
    x = (angle + pi) / (2 * pi) * grid.rows
    y = (angular_velocity + grid.limit) / (2 * grid.limit) * (grid.columns - 1)
    y = min(max(y, 0.0), grid.columns - 1.0)
    i = min(floor(x), grid.rows - 1)
    j = min(floor(y), grid.columns - 2)
    return i * grid.columns + j, x - i, y - j


@compiled
def between(columns: int, values: Array, corner: int, up: float, across: float) -> float:
    """``values`` inside a cell, bilinear.

    In steps from one corner, not as a sum of weights: what is the same at all corners is so inside
    to the last bit, and actions that are equally good are found to be.
    """
    upper = corner + columns
    if upper >= len(values):
        upper -= len(values)
    below = values[corner] + across * (values[corner + 1] - values[corner])
    above = values[upper] + across * (values[upper + 1] - values[upper])
    inside: float = below + up * (above - below)
    return inside


@compiled
def interpolate(grid: Grid, values: Array, angle: float, angular_velocity: float) -> float:
    """``values``, shape (points,), at φ [rad] in ±π and φ̇ [rad/s]."""
    corner, up, across = place(grid, angle, angular_velocity)
    return between(grid.columns, values, corner, up, across)


@compiled
def step(body: Pendulum, angle: float, angular_velocity: float, action: int) -> tuple[float, float]:
    """φ [rad] within one turn and φ̇ [rad/s] after a step with an action."""
    next_angle, next_velocity = pendulum.step(
        body, angle, angular_velocity, body.accelerations[action]
    )
    return tasks.wrapped(next_angle), next_velocity


@compiled
def _fill(body: Pendulum, grid: Grid, angles: Array, velocities: Array, found: Successors) -> None:
    for point in range(len(angles)):
        for action in range(len(body.accelerations)):
            angle, velocity = step(body, angles[point], velocities[point], action)
            corner, up, across = place(grid, angle, velocity)
            found.angle[point, action] = angle
            found.corner[point, action] = corner
            found.up[point, action] = up
            found.across[point, action] = across


@compiled
def _interpolate_all(
    grid: Grid, values: Array, angles: Array, velocities: Array, found: Array
) -> None:
    for point in range(len(angles)):
        found[point] = interpolate(grid, values, angles[point], velocities[point])
