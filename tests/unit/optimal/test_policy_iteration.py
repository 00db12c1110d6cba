"""Policy iteration against value iteration, and evaluation against a linear system that scipy solves."""

import numpy as np
import pytest
from scipy.sparse import coo_array, eye_array
from scipy.sparse.linalg import spsolve

from upswing.optimal.policy_iteration import Moment, evaluated, improved, policy_iteration
from upswing.optimal.settling import METHODS, POLICY_ITERATION, VALUE_ITERATION, settle
from upswing.optimal.state_grid import Grid, Successors, interpolate, points, step, successors
from upswing.optimal.value_iteration import TOLERANCE, optimal_values
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import reward

TINY = Grid(24, 21)
BODY = Pendulum()
FIVE = Pendulum(length=0.4, accelerations=(-20.0, -10.0, 0.0, 10.0, 20.0))


def transitions(grid: Grid, ways: Successors, policy: np.ndarray) -> coo_array:
    """P of a policy: the weights of the four corners around where it leads, (points, points)."""
    of = np.arange(len(policy))
    corner, up, across = (each[of, policy] for each in (ways.corner, ways.up, ways.across))
    above = (corner + grid.columns) % len(policy)
    weights = ((1 - up) * (1 - across), (1 - up) * across, up * (1 - across), up * across)
    columns = (corner, corner + 1, above, above + 1)
    return coo_array(
        (np.concatenate(weights), (np.tile(of, 4), np.concatenate(columns))),
        shape=(len(policy), len(policy)),
    )


@pytest.mark.parametrize("discount", [0.7, 0.95])
def test_evaluation_solves_the_linear_system_of_the_policy(discount):
    ways = successors(BODY, TINY)
    policy = np.random.default_rng(0).integers(3, size=len(ways.corner)).astype(np.int8)
    rewards = -(ways.angle[np.arange(len(policy)), policy] ** 2)
    system = eye_array(len(policy)) - discount * transitions(TINY, ways, policy)
    exact = spsolve(system.tocsc(), rewards)
    begun = np.random.default_rng(1).normal(size=len(policy))
    values, is_exact = evaluated(TINY, ways, discount, policy, begun)
    assert is_exact
    np.testing.assert_allclose(values, exact, atol=TOLERANCE)
    once, is_exact = evaluated(TINY, ways, discount, policy, begun, patience=1)
    assert not is_exact
    np.testing.assert_allclose(once, rewards + discount * (transitions(TINY, ways, policy) @ begun))


def test_improvement_is_greedy_and_keeps_what_is_as_good():
    ways = successors(BODY, TINY)
    values = optimal_values(TINY, ways, 0.9)
    policy = np.zeros(len(values), np.int8)
    changed = improved(TINY, ways, 0.9, values, policy)
    assert changed == np.count_nonzero(policy) > 0
    for point, (angle, velocity) in enumerate(np.transpose(points(TINY)).tolist()):
        promised = []
        for action in range(3):
            after = step(BODY, angle, velocity, action)
            promised.append(reward(after[0]) + 0.9 * interpolate(TINY, values, *after))
        assert promised[policy[point]] >= max(promised) - 2 * TOLERANCE - 1e-9
    settled = policy.copy()
    assert improved(TINY, ways, 0.9, values, settled) == 0
    np.testing.assert_array_equal(settled, policy)
    # Where all values are the same, what an action earns at once decides; equals change nothing.
    indifferent = np.ones_like(policy)
    far = Successors(np.zeros_like(ways.angle), ways.corner, ways.up, ways.across)
    assert improved(TINY, far, 0.9, np.zeros_like(values), indifferent) == 0


@pytest.mark.parametrize("patience", [None, 1, 10])
@pytest.mark.parametrize("body", [BODY, FIVE], ids=["thesis", "five actions"])
def test_it_ends_where_value_iteration_does(body, patience):
    ways = successors(body, TINY)
    best = optimal_values(TINY, ways, 0.95)
    seen: list[Moment] = []
    policy, values = policy_iteration(TINY, ways, 0.95, patience, seen.append)
    np.testing.assert_allclose(values, best, atol=TOLERANCE / (1 - 0.95))
    assert improved(TINY, ways, 0.95, best, policy.copy()) <= 0.01 * len(policy)
    assert seen[-1].backups == len(seen) + len(body.accelerations) * seen[-1].improvements


def test_every_improvement_makes_the_policy_better_everywhere():
    ways = successors(BODY, TINY)
    policy, values = np.zeros(len(ways.corner), np.int8), np.zeros(len(ways.corner))
    means = []
    for _ in range(3):
        before = values
        values, _ = evaluated(TINY, ways, 0.9, policy, values)
        if means:
            assert (values >= before - 2 * TOLERANCE).all()
        means.append(values.mean())
        improved(TINY, ways, 0.9, values, policy)
    assert means == sorted(means)
    assert means[0] < means[-1]


def test_the_rows_say_how_value_and_policy_settle():
    rows = settle(BODY, TINY, 0.8)
    for method in METHODS:
        own = [row for row in rows if row.method == method]
        backups = [row.backups for row in own]
        assert backups == sorted(set(backups))
        assert own[0].error > 1
        assert own[0].worse > 0.1
        assert own[-1].error < 0.01
        assert own[-1].worse < 0.01
    ways, seen = successors(BODY, TINY), []
    optimal_values(TINY, ways, 0.8, swept=seen.append)
    ends = {row.method: row.backups for row in rows}
    assert ends[VALUE_ITERATION] == 3 * len(seen)
    moments: list[Moment] = []
    policy_iteration(TINY, ways, 0.8, None, moments.append)
    assert ends[POLICY_ITERATION] == moments[-1].backups
    # After one sweep from V = 0, V is the best reward of a step.
    first = next(row for row in rows if row.method == VALUE_ITERATION)
    one = -(ways.angle**2).min(axis=1)
    assert first.error == pytest.approx(np.abs(one - optimal_values(TINY, ways, 0.8)).max())
