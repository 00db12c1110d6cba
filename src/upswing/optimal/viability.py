"""From where the pendulum can be kept above an angle forever, and how fast it may swing up to it."""

from functools import cache
from math import atan

import numpy as np

from upswing.optimal.state_grid import Array, Grid, Successors, between, interpolate, points
from upswing.physics.braking import highest_speed_short_of, mirrored
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL

HALF = 0.5
"""Share of what lies between the points of a grid that has to be kept."""

TOLERANCE = 1e-6
"""A share is known when no sweep changes it by more."""

ROUNDING = 1e-9
"""A point this far beyond the angle still counts as on it [rad]."""


def kept_shares(grid: Grid, ways: Successors, largest_angle: float) -> Array:
    """How much of each point's surroundings can be kept within ± ``largest_angle`` [rad] forever.

    0 to 1, shape (points,). The viability kernel is where it is at least ``HALF``: at first all
    within the angle, from which a point is taken as far as no action leads to what is left.
    """
    angles, _ = points(grid)
    kept = (np.abs(angles) <= largest_angle + ROUNDING).astype(np.float64)
    while _sweep(grid.columns, ways, kept) > TOLERANCE:
        pass
    return kept


@compiled
def _sweep(columns: int, ways: Successors, kept: Array) -> float:
    """Take from every point what no action keeps, in place; the largest change."""
    largest = 0.0
    for point in range(len(kept)):
        if kept[point] > 0:
            best = 0.0
            for action in range(ways.corner.shape[1]):
                share = between(
                    columns,
                    kept,
                    ways.corner[point, action],
                    ways.up[point, action],
                    ways.across[point, action],
                )
                best = max(best, share)
            # Never more than before: rounding must not let it go up and down for ever.
            best = min(best, kept[point])
            largest = max(largest, kept[point] - best)
            kept[point] = best
    return largest


def catchable_speed_on(grid: Grid, kept: Array) -> float:
    """The highest φ̇ [rad/s] at −90° from which the grid says that the pendulum can be caught.

    Not the border of an interval from zero: who is too slow there falls back.
    """
    speeds = np.linspace(0, grid.limit, 10 * grid.columns)
    shares = np.array([interpolate(grid, kept, -HORIZONTAL, float(speed)) for speed in speeds])
    last = int(np.flatnonzero(shares >= HALF)[-1])
    into = (shares[last] - HALF) / (shares[last] - shares[last + 1])
    return float(speeds[last] + into * (speeds[last + 1] - speeds[last]))


def balanced_angle(body: Pendulum) -> float:
    """Where gravity and the full push of the cart are in balance, above the horizontal [rad].

    A saddle, at tan φ = ẍ/g (eq. 14, 16): beyond it gravity wins, whatever the cart does.
    """
    return atan(-body.accelerations[0] / body.gravity)


@cache
def catchable_speed(body: Pendulum) -> float:
    """The same by shooting, without a grid and to 10⁻⁹ rad/s.

    Full braking from it leads to the balanced angle and never arrives: the stable way to the saddle.
    Whoever passes that angle is lost, so ``braking.highest_stoppable_speed``, which asks whether it
    comes to rest before the other horizontal, is the same number.
    """
    sides = (body, mirrored(body))
    return min(highest_speed_short_of(one, balanced_angle(one)) for one in sides)
