"""Prediction: what a fixed policy is worth, estimated from what was met under it (§2.4.3, §2.4.4).

Nothing is chosen here, so experience comes first and all methods learn from the same. A method is a
named tuple of arrays, stepped in place; its file gives a body to ``learn``, which is called once a step,
in order, and looks at nothing that was met later.
"""

from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.physics.jit import ByType, compiled

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

ENDED = -1
"""The tile of a state that ends an episode: nothing follows, so its value is 0."""


class StepSize(NamedTuple):
    """How far a tile is moved towards a target: α / (1 + n/h) after n updates, as in ``decaying``."""

    first: float  # α
    halved_after: float = inf  # h: how many updates halve it


AVERAGE = StepSize(1.0, 1.0)
"""1/N: with it, V of a tile is the average of its N targets."""


class Experience(NamedTuple):
    """What was met; row t holds s_t and what followed. Every array has shape (steps,)."""

    angle: Array  # φ of s_t [rad]
    angular_velocity: Array  # φ̇ of s_t [rad/s]
    tile: Whole  # of s_t
    reward: Array  # r_{t+1} [rad²]
    after: Whole  # the tile of s_{t+1}; ENDED where that ends the episode
    begun: Whole  # the step with which the episode of s_t began


class Estimate(NamedTuple):
    """V as it is so far."""

    values: Array  # V, (tiles,) [rad²]
    updates: Whole  # n: how often each was moved, (tiles,)
    step_size: StepSize


def nothing_known(tiles: int, step_size: StepSize) -> Estimate:
    """V = 0 in every tile."""
    return Estimate(np.zeros(tiles), np.zeros(tiles, np.int64), step_size)


def _learn(method: Any, _experience: Experience, _discount: float, _t: int) -> None:
    """Learn from experience what step ``t`` makes known, with the discount γ."""
    raise TypeError(f"{type(method)} is no method of prediction")


_learn_by_type = ByType(_learn)
learn = _learn_by_type.call
learn_of = _learn_by_type.register


@compiled
def value_of(estimate: Estimate, tile: int) -> float:
    """V of a tile [rad²]; 0 where an episode ended."""
    if tile == ENDED:
        return 0.0
    value: float = estimate.values[tile]
    return value


@compiled
def share(step_size: StepSize, updates: int) -> float:
    """How far V of a tile is moved towards a target after so many updates."""
    return step_size.first / (1.0 + updates / step_size.halved_after)


@compiled
def move(estimate: Estimate, tile: int, target: float) -> None:
    """V(s) ← V(s) + α [target − V(s)]."""
    step_size = share(estimate.step_size, estimate.updates[tile])
    estimate.values[tile] += step_size * (target - estimate.values[tile])
    estimate.updates[tile] += 1


@compiled
def predict(
    method: Any, experience: Experience, discount: float, moments: Whole, kept: Array
) -> None:
    """Learn from all that was met.

    Args:
        method: what learns, in place.
        experience: what was met.
        discount: γ.
        moments: the numbers of steps after which V is looked at, ascending, (moments,).
        kept: what V was then, (moments, tiles) [rad²]; filled.
    """
    moment = 0
    for t in range(len(experience.tile)):
        learn(method, experience, discount, t)
        if moment < len(moments) and t + 1 == moments[moment]:
            for tile in range(kept.shape[1]):
                kept[moment, tile] = method.estimate.values[tile]
            moment += 1
