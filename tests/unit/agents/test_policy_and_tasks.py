"""Choosing actions; starting, falling, wrapping."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import chisquare

from upswing.agents.policy import epsilon_greedy
from upswing.physics import tasks
from upswing.study.readings import Readings

DRAWS = (np.arange(60_000) + 0.5) / 60_000
values = st.tuples(*[st.integers(-2, 2).map(float)] * 3)


@given(values, st.floats(0.011, 1, exclude_max=True))
def test_above_epsilon_the_action_is_greedy(q, draw):
    assert q[epsilon_greedy(q, 0.01, True, draw)] == max(q)
    assert epsilon_greedy(q, 0.01, False, draw) == int(np.argmax(q))


@given(values, st.floats(0, 1, exclude_max=True))
def test_every_draw_gives_an_action(q, draw):
    for epsilon in (0.0, 0.01, 0.5, 1.0):
        assert epsilon_greedy(q, epsilon, True, draw) in (0, 1, 2)


@pytest.mark.parametrize("epsilon", [0.0, 0.01, 0.3, 1.0])
@pytest.mark.parametrize("q", [(0.0, 0.0, 0.0), (1.0, 0.0, 1.0), (0.0, 1.0, 1.0), (0.0, 0.0, 2.0)])
def test_shares_of_actions(q, epsilon):
    """Evenly spread draws give each action its probability."""
    counts = np.bincount([epsilon_greedy(q, epsilon, True, draw) for draw in DRAWS], minlength=3)
    best = np.array(q) == max(q)
    expected = epsilon / 3 + (1 - epsilon) * best / best.sum()
    assert counts / len(DRAWS) == pytest.approx(expected, abs=2e-4)


def test_random_draws_pass_a_chi_squared_test():
    rng = np.random.default_rng(5)
    chosen = [epsilon_greedy((0.0, 0.0, 0.0), 0.01, True, rng.random()) for _ in range(3_000)]
    assert chisquare(np.bincount(chosen)).pvalue > 1e-4


def test_a_value_that_is_not_a_number_does_not_stop_the_policy():
    assert epsilon_greedy((np.nan, np.nan, np.nan), 0.01, True, 0.5) in (0, 1, 2)


@pytest.mark.parametrize(
    ("kind", "widest"), [("balancing", np.radians(20)), ("full-control", np.pi)]
)
def test_starts_fill_their_range(kind, widest):
    task, rng = tasks.create(kind, Readings()), np.random.default_rng(1)
    starts = np.array([tasks.start(task, rng) for _ in range(4_000)])
    assert np.abs(starts[:, 0]).max() <= widest
    counts, _ = np.histogram(starts[:, 0], 8, (-widest, widest))
    assert chisquare(counts).pvalue > 1e-4
    assert (starts[:, 1] == 0).all()


def test_random_start_velocities_leave_the_angles_as_they_were():
    still, moving = (
        tasks.create("balancing", Readings(start_velocity=v)) for v in ("zero", "random")
    )
    one, other = np.random.default_rng(1), np.random.default_rng(1)
    a = np.array([tasks.start(still, one) for _ in range(500)])
    b = np.array([tasks.start(moving, other) for _ in range(500)])
    np.testing.assert_array_equal(a[:, 0], b[:, 0])
    assert 1.9 < np.abs(b[:, 1]).max() <= 2


def test_only_balancing_falls():
    balancing, full = (tasks.create(kind, Readings()) for kind in ("balancing", "full-control"))
    assert tasks.fallen(balancing, np.radians(90.1), 0.0)
    assert not tasks.fallen(balancing, np.radians(-89.9), 0.0)
    assert not tasks.fallen(full, np.pi, 0.0)


@given(st.floats(-2.9 * np.pi, 2.9 * np.pi))
def test_wrapping_keeps_the_place(angle):
    wrapped = tasks.wrapped(angle)
    assert -np.pi <= wrapped < np.pi
    assert np.cos(wrapped) == pytest.approx(np.cos(angle), abs=1e-12)
    assert np.sin(wrapped) == pytest.approx(np.sin(angle), abs=1e-12)


@given(st.floats(-7, 7))
def test_reward_is_highest_upright(angle):
    assert tasks.reward(angle) == -angle * angle <= tasks.reward(0.0)
