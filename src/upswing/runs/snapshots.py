"""What a learner knows, at some moments of its training."""

from functools import cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Encoder, locate
from upswing.agents.learners import Learner

MOMENTS = 40
"""Approximate number of moments, dense at the beginning, where learning is fast."""

Real = NDArray[np.float64]


class Snapshots(NamedTuple):
    """Values over a grid, φ by φ̇, as they grew: that of the tiles, or a fine one."""

    steps: NDArray[np.int64]  # before which step: (moments,)
    q: Real  # in the unit of R3: (moments, angle parts, velocity parts, actions)
    owner: NDArray[np.int64]  # the module that owns a tile: (angle parts, velocity parts)
    angle_limit: float  # the grid covers ± this [rad]
    velocity_limit: float  # … and ± this [rad/s]


def moments(steps: int) -> NDArray[np.int64]:
    """When to look, from 0 to ``steps``: half of it evenly spread, half evenly in the logarithm."""
    half = MOMENTS // 2
    spread = np.linspace(0, steps, half)
    early = np.geomspace(min(100, steps), steps, half)
    return np.unique(np.concatenate([spread, early]).round().astype(np.int64))


def snapshots(encoder: Encoder, looked: list[tuple[int, Real]]) -> Snapshots:
    """What was looked at: (step, what ``look`` gave) of each moment."""
    rows, columns, angle_limit, velocity_limit = encoder.picture
    owner = np.array([place.module for place in places(encoder)]).reshape(rows, columns)
    return Snapshots(
        steps=np.array([step for step, _ in looked]),
        q=np.stack([values for _, values in looked]),
        owner=owner,
        angle_limit=angle_limit,
        velocity_limit=velocity_limit,
    )


def look(learner: Learner, encoder: Encoder) -> Real:
    """What a learner knows now: (angle parts, velocity parts, actions) of its encoder's picture."""
    rows, columns, _, _ = encoder.picture
    return learner.action_values(places(encoder)).reshape(rows, columns, -1)


@cache
def places(encoder: Encoder) -> list[Any]:
    """The places at the middle of every part of an encoder's picture, a row of φ after the other."""
    rows, columns, limit, fastest = encoder.picture
    angles = -limit + (np.arange(rows) + 0.5) * 2 * limit / rows
    velocities = -fastest + (np.arange(columns) + 0.5) * 2 * fastest / columns
    return [
        locate(encoder, float(angle), float(velocity))
        for angle in angles
        for velocity in velocities
    ]
