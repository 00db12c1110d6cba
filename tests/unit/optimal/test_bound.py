"""Dynamic programming against plain transcriptions, closed forms, shooting and simulation."""

from functools import cache

import numpy as np
import pytest
from scipy.interpolate import RegularGridInterpolator

from upswing.optimal.follow import from_starts, without_exploring
from upswing.optimal.min_time import arrived, steps_taken
from upswing.optimal.policies import act
from upswing.optimal.solved import Solved, at_rest, solve
from upswing.optimal.state_grid import Grid, interpolate, points, successors
from upswing.optimal.value_iteration import Optimal, optimal_values, promised
from upswing.optimal.viability import (
    HALF,
    balanced_angle,
    catchable_speed,
    catchable_speed_on,
    kept_shares,
)
from upswing.physics import pendulum
from upswing.physics.braking import highest_stoppable_speed
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL
from upswing.runs.metrics import UPRIGHT

BODY = Pendulum()
TINY, SMALL, MIDDLE, FINE = Grid(36, 21), Grid(72, 81), Grid(144, 161), Grid(288, 321)


@cache
def solved(grid: Grid) -> Solved:
    return solve(BODY, grid)


def stepped(angle, velocity, action):
    """The step of the thesis on arrays, with numpy's own sine and cosine (eq. 13–23), within one turn."""
    inertia = BODY.mass * BODY.length**2 / 3
    lever = BODY.mass * BODY.length / 2
    torque = lever * (BODY.gravity * np.sin(angle) + BODY.accelerations[action] * np.cos(angle))
    velocity = velocity + (torque - BODY.friction * velocity) / inertia * BODY.time_step
    angle = angle + velocity * BODY.time_step
    return (angle + np.pi) % (2 * np.pi) - np.pi, velocity


def by_scipy(grid, values, angle, velocity):
    """Linear interpolation with the first row once more behind the last."""
    angles = np.linspace(-np.pi, np.pi, grid.rows + 1)
    velocities = np.linspace(-grid.limit, grid.limit, grid.columns)
    square = values.reshape(grid.rows, grid.columns)
    closed = np.vstack([square, square[:1]])
    clipped = np.clip(velocity, -grid.limit, grid.limit)
    return RegularGridInterpolator((angles, velocities), closed)((angle, clipped))


def test_between_the_points_scipy_says_the_same():
    rng = np.random.default_rng(0)
    values = rng.normal(size=TINY.rows * TINY.columns)
    angles, velocities = rng.uniform(-np.pi, np.pi, 500), rng.uniform(-30, 30, 500)
    ours = [interpolate(TINY, values, *state) for state in zip(angles, velocities, strict=True)]
    np.testing.assert_allclose(ours, by_scipy(TINY, values, angles, velocities), atol=1e-12)


def test_what_is_bilinear_is_met_exactly_and_what_is_constant_to_the_last_bit():
    angles, velocities = points(TINY)
    values = 1 + 2 * angles - 3 * velocities + 0.5 * angles * velocities
    rng = np.random.default_rng(1)
    for angle, velocity in rng.uniform((-3, -25), (2.9, 25), size=(200, 2)):
        exact = 1 + 2 * angle - 3 * velocity + 0.5 * angle * velocity
        assert interpolate(TINY, values, angle, velocity) == pytest.approx(exact, abs=1e-10)
        assert interpolate(TINY, np.full_like(values, 1 / 3), angle, velocity) == 1 / 3


def test_across_the_seam_the_last_row_leads_to_the_first():
    square = np.zeros((TINY.rows, TINY.columns))
    square[0], square[-1] = 2.0, 1.0
    width = 2 * np.pi / TINY.rows
    assert interpolate(TINY, square.ravel(), np.pi - width / 4, 3.3) == pytest.approx(1.75)


def test_value_iteration_against_numpy_and_scipy():
    discount, values = 0.9, np.zeros(TINY.rows * TINY.columns)
    ways = [stepped(*points(TINY), action) for action in range(3)]
    for _ in range(250):  # 0.9²⁵⁰ · π² / (1 − 0.9) < 10⁻⁹
        values = np.max(
            [-(a**2) + discount * by_scipy(TINY, values, a, v) for a, v in ways], axis=0
        )
    ours = optimal_values(TINY, successors(BODY, TINY), discount)
    np.testing.assert_allclose(ours, values, atol=2e-6)
    assert optimal_values(TINY, successors(BODY, TINY), discount, values) == pytest.approx(
        values, abs=2e-6
    )


def test_without_a_future_only_the_next_reward_counts():
    values = optimal_values(SMALL, successors(BODY, SMALL), 0.0)
    outcomes = [stepped(*points(SMALL), action)[0] for action in range(3)]
    np.testing.assert_allclose(values, -np.min(np.square(outcomes), axis=0), atol=1e-9)
    policy = Optimal(SMALL, values, 0.0)
    rng = np.random.default_rng(2)
    for angle, velocity in rng.uniform((-3, -20), (3, 20), size=(200, 2)):
        tilts = [abs(stepped(angle, velocity, action)[0]) for action in range(3)]
        assert act(policy, BODY, angle, velocity) == int(np.argmin(tilts))


def test_values_against_every_sequence_of_nine_actions():
    """Without a grid: what comes after nine steps is between nothing and the worst, discounted."""
    discount, depth = 0.5, 9
    policy = Optimal(MIDDLE, optimal_values(MIDDLE, successors(BODY, MIDDLE), discount), discount)
    rest = discount**depth * np.pi**2 / (1 - discount)
    rng = np.random.default_rng(3)
    for start in rng.uniform((-2.5, -12), (2.5, 12), size=(20, 2)):
        angles, velocities = (np.array([part]) for part in start)
        returns = np.zeros(1)
        for ahead in range(depth):
            ways = [stepped(angles, velocities, action) for action in range(3)]
            angles, velocities = (np.concatenate(parts) for parts in zip(*ways, strict=True))
            returns = np.tile(returns, 3) - discount**ahead * angles**2
        best = max(promised(policy, BODY, *start, action) for action in range(3))
        # Linear interpolation of −φ² errs by up to width²/8 · 2, each time it is believed.
        width = 2 * np.pi / MIDDLE.rows
        assert returns.max() - rest - width**2 <= best <= returns.max() + width**2


def test_of_equally_good_actions_the_first_is_taken():
    flat = Optimal(TINY, np.zeros(TINY.rows * TINY.columns), 0.9)
    # Hanging, left and right are mirror images.
    assert promised(flat, BODY, -np.pi, 0.0, 0) == promised(flat, BODY, -np.pi, 0.0, 2)
    assert act(flat, BODY, -np.pi, 0.0) == 0


def shot(angle):
    """The highest φ̇ from φ that full braking still brings to rest before the balanced angle."""
    low, high = 0.0, 50.0
    while high - low > 1e-6:
        middle = (low + high) / 2
        at, velocity = angle, middle
        while velocity > 0 and at <= balanced_angle(BODY):
            at, velocity = pendulum.step(BODY, at, velocity, -10.0)
        low, high = (low, middle) if velocity > 0 else (middle, high)
    return low


def test_the_border_of_the_kernel_nears_what_shooting_finds():
    angles = np.radians([-80, -60, -40, -20, 0, 20, 35])
    exact = np.array([shot(float(angle)) for angle in angles])
    speeds = np.linspace(0, 25, 5001)
    errors = []
    for grid in (SMALL, MIDDLE, FINE):
        kept = kept_shares(grid, successors(BODY, grid), HORIZONTAL)
        found = [
            speeds[np.flatnonzero([interpolate(grid, kept, a, s) >= HALF for s in speeds])[-1]]
            for a in angles
        ]
        errors.append(np.abs(found - exact).max())
        assert catchable_speed_on(grid, kept) == pytest.approx(catchable_speed(BODY), abs=0.05)
    assert errors[2] < errors[1] < errors[0]
    assert errors[2] < 0.15


def test_kept_states_are_kept_by_simulation_and_lost_ones_are_lost():
    """Of states well inside none leaves ±20°; of those outside none comes to rest, braking fully."""
    policy = solved(MIDDLE).fastest
    rng = np.random.default_rng(4)
    inside = outside = 0
    for angle, velocity in rng.uniform((-UPRIGHT, -15), (UPRIGHT, 15), size=(800, 2)):
        share = interpolate(MIDDLE, policy.kept, angle, velocity)
        if share == 1:
            inside += 1
            run = without_exploring(policy, BODY, angle, velocity, 1_000)
            assert np.abs(run).max() <= UPRIGHT + 1e-9
        elif share < 1e-3:
            outside += 1
            at, speed = angle, velocity
            while abs(at) <= UPRIGHT and speed * velocity > 0:
                at, speed = stepped(at, speed, 0 if velocity > 0 else 2)
            assert abs(at) > UPRIGHT
    assert inside > 50
    assert outside > 50


def test_what_is_caught_at_the_horizontal_is_what_comes_to_rest():
    """Beyond the balanced angle gravity wins, so nothing comes to rest between it and +90°."""
    uneven = [Pendulum(accelerations=pushes) for pushes in ((-20.0, 0.0, 10.0), (-10.0, 20.0))]
    for body in (BODY, Pendulum(friction=0.0), Pendulum(gravity=5.0, time_step=1e-3), *uneven):
        assert catchable_speed(body) == pytest.approx(highest_stoppable_speed(body), abs=1e-6)


def test_just_below_the_catchable_speed_it_is_held():
    at, velocity = -HORIZONTAL, catchable_speed(BODY) - 1e-6
    angles = []
    while not (velocity < 0 and at <= UPRIGHT):
        at, velocity = pendulum.step(BODY, at, velocity, -10.0)
        angles.append(at)
    assert max(angles) < balanced_angle(BODY)
    assert max(angles) > balanced_angle(BODY) - 1e-2  # it was close
    held = without_exploring(solved(SMALL).optimal[0.99], BODY, at, velocity, 4_000)
    assert np.abs(held).max() < HORIZONTAL
    assert np.abs(held[-1_000:]).max() < UPRIGHT


def test_just_above_the_catchable_speed_no_actions_hold_it():
    rng = np.random.default_rng(5)
    for attempt in range(200):
        at, velocity = -HORIZONTAL, catchable_speed(BODY) + 1e-3
        braking = 1.0 - attempt / 400  # from full braking to half of it
        for _ in range(400):
            action = -10.0 if rng.random() < braking else float(rng.choice([0.0, 10.0]))
            at, velocity = pendulum.step(BODY, at, velocity, action)
            if abs(at) > HORIZONTAL:
                break
        assert at > HORIZONTAL


def test_the_time_that_is_promised_is_the_time_it_takes():
    """… on finer grids ever more exactly."""
    errors = []
    for grid in (SMALL, MIDDLE, FINE):
        policy, compared = solved(grid).fastest, []
        for angle, velocity in np.random.default_rng(6).uniform((-3, -8), (3, 8), size=(200, 2)):
            said = interpolate(grid, policy.steps, angle, velocity)
            took = steps_taken(policy, BODY, angle, velocity)
            assert took >= 0
            assert (took == 0) == arrived(policy, angle, velocity)
            compared.append(abs(said - took))
        errors.append(np.mean(compared))
        assert np.median(compared) < 4
        hanging = steps_taken(policy, BODY, -np.pi, 0.0)
        assert hanging == pytest.approx(at_rest(grid, policy.steps)[0], abs=10)
    assert errors[2] < errors[1] < errors[0]
    assert errors[2] < 1.0  # steps, of up to 120


def test_no_other_policy_is_faster_than_the_fastest():
    """… than the optimal ones of every γ, and than random ones, to the width of a cell."""
    bound = solved(MIDDLE)
    promise = at_rest(MIDDLE, bound.steps)[0]
    for policy in bound.optimal.values():
        angle, velocity, taken = -np.pi, 0.0, 0
        while not arrived(bound.fastest, angle, velocity) and taken < 1_000:
            angle, velocity = stepped(angle, velocity, act(policy, BODY, angle, velocity))
            taken += 1
        assert taken > promise - 4


def test_at_the_target_no_time_is_needed():
    bound = solved(SMALL)
    angles, velocities = points(SMALL)
    upright = (angles == 0) & (velocities == 0)
    assert upright.sum() == 1
    assert bound.steps[upright] == 0
    np.testing.assert_array_equal(bound.steps == 0, bound.upright >= HALF)


def test_a_short_horizon_does_not_swing_up_and_a_long_one_does():
    """The optimum of γ = 0.7 pushes towards upright all the time and comes to rest half way."""
    for grid in (SMALL, MIDDLE):
        short, long = (solved(grid).optimal[discount] for discount in (0.7, 0.99))
        hanging = without_exploring(short, BODY, -np.pi, 0.0, 4_000)
        assert np.abs(hanging).min() > HORIZONTAL
        assert np.abs(hanging[-200:]).mean() == pytest.approx(
            np.pi - balanced_angle(BODY), abs=0.05
        )
        assert not from_starts(short, BODY).from_hanging
        assert 0 < from_starts(short, BODY).success_share < 0.5
        assert from_starts(long, BODY).success_share == 1


def test_the_push_towards_upright_alone_does_not_swing_up_either():
    """The same without a grid and without a plan: the sign of the torque is all it knows."""
    angle, velocity, highest = -3.0, 0.0, np.pi
    for _ in range(4_000):
        towards = -np.sign(angle) * np.sign(np.cos(angle))
        angle, velocity = stepped(angle, velocity, int(1 + towards))
        highest = min(highest, abs(angle))
    assert highest > HORIZONTAL
