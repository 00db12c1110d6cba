"""Policy iteration (§2.4.1, §2.4.2): evaluate a policy, improve it, until nothing changes."""

from collections.abc import Callable
from itertools import count
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.optimal.state_grid import Array, Grid, Successors, between
from upswing.optimal.value_iteration import TOLERANCE
from upswing.physics.jit import compiled

Actions = NDArray[np.int8]
"""The action in every point, (points,): an index into the body's accelerations."""


class Moment(NamedTuple):
    """What can be seen after each sweep; the arrays change with the next one."""

    improvements: int  # how often the policy was improved before
    values: Array  # V so far, (points,) [rad²]
    policy: Actions  # the policy whose value V is becoming
    backups: int  # values of (s, a) computed so far, in sweeps over all points


Watch = Callable[[Moment], None]


def _unwatched(_: Moment) -> None:
    """Nobody looks."""


def policy_iteration(
    grid: Grid,
    ways: Successors,
    discount: float,
    patience: int | None = None,
    watch: Watch = _unwatched,
) -> tuple[Actions, Array]:
    """The policy that no improvement changes, and its V, (points,) [rad²].

    It begins with the first action in every point and V = 0. Every evaluation begins with the values
    that the one before ended with.

    Args:
        grid: its points.
        ways: where the actions lead from them.
        discount: γ, below 1.
        patience: largest number of sweeps of an evaluation before the next improvement (Puterman and
            Shin 1978); as many as it needs if there is none.
        watch: is called after every sweep.
    """
    points, actions = ways.corner.shape
    policy, values = np.zeros(points, np.int8), np.zeros(points)
    improvements = backups = 0
    while True:

        def swept(found: Array) -> None:
            nonlocal backups
            backups += 1
            watch(Moment(improvements, found, policy, backups))  # noqa: B023  called at once

        values, is_exact = evaluated(grid, ways, discount, policy, values, patience, swept)
        if not improved(grid, ways, discount, values, policy) and is_exact:
            return policy, values
        improvements += 1
        backups += actions


def evaluated(
    grid: Grid,
    ways: Successors,
    discount: float,
    policy: Actions,
    begun: Array,
    patience: int | None = None,
    swept: Callable[[Array], None] = lambda _: None,
) -> tuple[Array, bool]:
    """Policy evaluation: V of ``policy``, shape (points,) [rad²], and whether it is so to ``TOLERANCE``.

    Sweep by sweep as in §2.4.2; when to end follows from the least and the largest change, as in
    ``value_iteration.optimal_values``.

    Args:
        grid: its points.
        ways: where the actions lead from them.
        discount: γ, below 1.
        policy: the action in every point.
        begun: the values to begin with; the better the faster.
        patience: largest number of sweeps; as many as it takes if there is none.
        swept: is given the values after every sweep.
    """
    values, better, further = begun.copy(), np.empty_like(begun), discount / (1 - discount)
    for _ in count() if patience is None else range(patience):
        low, high = _evaluate(grid.columns, ways, discount, policy, values, better)
        values, better = better, values
        if further * (high - low) <= 2 * TOLERANCE:
            found: Array = values + further * (low + high) / 2
            swept(found)
            return found, True
        swept(values)
    return values, False


def improved(grid: Grid, ways: Successors, discount: float, values: Array, policy: Actions) -> int:
    """Policy improvement: ``policy`` becomes greedy for ``values``; in how many points that changes it.

    An action is left for another only if that is better by more than the values may be wrong. So every
    change makes the policy truly better, and it cannot go round among equally good ones for ever.
    """
    return int(_improve(grid.columns, ways, discount, values, policy, 2 * TOLERANCE))


@compiled
def _backed_up(
    columns: int, ways: Successors, discount: float, values: Array, point: int, action: int
) -> float:
    """R + γ V(s′) [rad²] for an action in a point (eq. 8)."""
    value: float = between(
        columns,
        values,
        ways.corner[point, action],
        ways.up[point, action],
        ways.across[point, action],
    )
    backed_up: float = -(ways.angle[point, action] ** 2) + discount * value
    return backed_up


@compiled
def _evaluate(
    columns: int, ways: Successors, discount: float, policy: Actions, values: Array, better: Array
) -> tuple[float, float]:
    """One sweep, ``values`` into ``better``; the least and the largest change."""
    low, high = inf, -inf
    for point in range(len(values)):
        value = _backed_up(columns, ways, discount, values, point, policy[point])
        better[point] = value
        low = min(low, value - values[point])
        high = max(high, value - values[point])
    return low, high


@compiled
def _improve(
    columns: int, ways: Successors, discount: float, values: Array, policy: Actions, margin: float
) -> int:
    changed = 0
    for point in range(len(values)):
        kept = policy[point]
        best, chosen = _backed_up(columns, ways, discount, values, point, kept) + margin, kept
        for action in range(ways.corner.shape[1]):
            value = _backed_up(columns, ways, discount, values, point, action)
            if value > best:
                best, chosen = value, action
        policy[point] = chosen
        changed += chosen != kept
    return changed
