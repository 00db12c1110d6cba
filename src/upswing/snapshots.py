"""What a learner knows, at some moments of its training."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.learners import Learner
from upswing.tiles import VELOCITY_LIMIT, VELOCITY_PARTS, Tiles, locate

MOMENTS = 40
"""About so many moments, dense at the beginning, where learning is fast."""

Real = NDArray[np.float64]


class Snapshots(NamedTuple):
    """Values over the grid of tiles, φ by φ̇, as they grew."""

    steps: NDArray[np.int64]  # before which step: (moments,)
    q: Real  # in the unit of R3: (moments, angle parts, velocity parts, actions)
    owner: NDArray[np.int64]  # the module that owns a tile: (angle parts, velocity parts)
    angle_limit: float  # the grid covers ± this [rad]


def moments(steps: int) -> NDArray[np.int64]:
    """When to look, from 0 to ``steps``: half of it evenly spread, half evenly in the logarithm."""
    half = MOMENTS // 2
    spread = np.linspace(0, steps, half)
    early = np.geomspace(min(100, steps), steps, half)
    return np.unique(np.concatenate([spread, early]).round().astype(np.int64))


def unfolded(tiles: Tiles, values: Real) -> Real:
    """Values (modules, tiles, …) laid out over the whole grid: (angle parts, velocity parts, …)."""
    modules, indices = _places(tiles)
    return values[modules, indices]


def snapshots(tiles: Tiles, looked: list[tuple[int, Real]]) -> Snapshots:
    """What was looked at: (step, values (modules, tiles, actions)) of each moment."""
    return Snapshots(
        steps=np.array([step for step, _ in looked]),
        q=np.stack([unfolded(tiles, values) for _, values in looked]),
        owner=_places(tiles)[0],
        angle_limit=tiles.angle_limit,
    )


def look(learner: Learner) -> Real:
    """What a learner knows now, (modules, tiles, actions), as a copy."""
    return learner.action_values().copy()


def _places(tiles: Tiles) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """(module, tile) at the middle of every part of the grid, each (angle parts, velocity parts)."""
    angle_width = 2 * tiles.angle_limit / tiles.angle_parts
    velocity_width = 2 * VELOCITY_LIMIT / VELOCITY_PARTS
    places = [
        [
            locate(
                tiles,
                -tiles.angle_limit + (row + 0.5) * angle_width,
                -VELOCITY_LIMIT + (column + 0.5) * velocity_width,
            )
            for column in range(VELOCITY_PARTS)
        ]
        for row in range(tiles.angle_parts)
    ]
    both = np.array(places, dtype=np.int64)
    return both[..., 0], both[..., 1]
