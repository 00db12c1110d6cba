"""The shortest time to upright, there to stay: a shortest path, without discount."""

from math import inf
from typing import NamedTuple

import numpy as np

from upswing.optimal.policies import act, act_of
from upswing.optimal.state_grid import Array, Grid, Successors, between, interpolate, step
from upswing.optimal.value_iteration import Optimal, promised
from upswing.optimal.viability import HALF
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum

TOLERANCE = 1e-4
"""A time is known when no sweep changes it by more [steps]."""

NEVER = 1e6
"""Number of steps that stands for endless, where nothing leads to upright."""

NEVER_TAKEN = 10_000
"""Number of steps after which the policy is taken never to arrive."""


class Fastest(NamedTuple):
    """The policy that gets upright in the shortest time and then stays there."""

    grid: Grid
    steps: Array  # steps to go, (points,)
    kept: Array  # how much can be kept upright, (points,): ``keepable.kept_shares`` for 20°
    then: Optimal  # what it does there, as long as that keeps it upright


@act_of(Fastest)
def _act(policy: Fastest, body: Pendulum, angle: float, angular_velocity: float) -> int:
    holding = arrived(policy, angle, angular_velocity)
    best, action = -inf, 0
    # Of equally good actions the first, as in the study (R6).
    for candidate in range(len(body.accelerations)):
        next_angle, next_velocity = step(body, angle, angular_velocity, candidate)
        if not holding:
            good = -interpolate(policy.grid, policy.steps, next_angle, next_velocity)
        elif arrived(policy, next_angle, next_velocity):
            good = promised(policy.then, body, angle, angular_velocity, candidate)
        else:
            kept = interpolate(policy.grid, policy.kept, next_angle, next_velocity)
            good = NEVER * (kept - 1.0)
        if good > best:
            best, action = good, candidate
    return action


@compiled
def arrived(policy: Fastest, angle: float, angular_velocity: float) -> bool:
    """Whether φ [rad] and φ̇ [rad/s] are upright and can be kept so."""
    return interpolate(policy.grid, policy.kept, angle, angular_velocity) >= HALF


@compiled
def steps_taken(policy: Fastest, body: Pendulum, angle: float, angular_velocity: float) -> int:
    """After how many true steps the policy has arrived, from φ [rad] and φ̇ [rad/s]; −1 if never."""
    for taken in range(NEVER_TAKEN):
        if arrived(policy, angle, angular_velocity):
            return taken
        action = act(policy, body, angle, angular_velocity)
        angle, angular_velocity = step(body, angle, angular_velocity, action)
    return -1


def steps_to(grid: Grid, ways: Successors, target: Array) -> Array:
    """The least number of steps from every point to where ``target`` ≥ ``HALF``; both (points,).

    From below: no steps at first, and more with every sweep as long as it turns out that a point
    is further away. At most ``NEVER``.
    """
    steps = np.zeros(len(target))
    change, forwards = inf, True
    while change > TOLERANCE:
        change = _sweep(grid.columns, ways, target, steps, forwards)
        forwards = not forwards
    return steps


@compiled
def _sweep(columns: int, ways: Successors, target: Array, steps: Array, forwards: bool) -> float:
    """One full backup of every point, in place, from the first or from the last; the largest change."""
    largest = 0.0
    for visit in range(len(steps)):
        point = visit if forwards else len(steps) - 1 - visit
        if target[point] < HALF:
            best = NEVER
            for action in range(ways.corner.shape[1]):
                further = between(
                    columns,
                    steps,
                    ways.corner[point, action],
                    ways.up[point, action],
                    ways.across[point, action],
                )
                best = min(best, 1.0 + further)
            # Never less than before: rounding must not let it go up and down for ever.
            best = max(best, steps[point])
            largest = max(largest, best - steps[point])
            steps[point] = best
    return largest
