"""Measures against their definitions in plain numpy."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.helpers import make_spec, run
from upswing.physics.braking import Stoppable
from upswing.physics.environment import empty_trajectory
from upswing.runs import metrics as measures

TOO_FAST = Stoppable(15.0, 15.0)


def made_of(angles, resets=(), reward=-1.0):
    trajectory = empty_trajectory(len(angles))
    trajectory.angle[:] = angles
    trajectory.reward[:] = reward
    trajectory.reset[list(resets)] = True
    return trajectory


def plain(trajectory):
    angle = trajectory.angle.astype(float)
    tilt = np.abs((angle + np.pi) % (2 * np.pi) - np.pi)
    above = tilt <= np.pi / 2
    fell = trajectory.reset.copy()
    fell[:-1] |= above[:-1] & ~above[1:]
    return tilt, above, fell


@pytest.mark.parametrize("kind", ["balancing", "full-control"])
@pytest.mark.parametrize("architecture", ["table", "random"])
def test_against_plain_numpy(kind, architecture):
    trajectory, _ = run(make_spec(kind, architecture, 0.5, steps=30_001))
    tilt, above, fell = plain(trajectory)
    found = measures.measure(trajectory, kind == "balancing", TOO_FAST)
    last = slice(30_001 - 6_000, None)
    assert found.steps == 30_001
    assert found.falls == fell.sum()
    assert found.falls_last_fifth == fell[last].sum()
    assert found.upright_share == pytest.approx((tilt[last] <= np.radians(20)).mean())
    assert found.above_horizontal_share == pytest.approx(above[last].mean())
    assert found.mean_reward == pytest.approx(trajectory.reward[last].mean(dtype=float), rel=1e-6)
    end = slice(30_001 - 6_000, None)  # shorter than 100,000 steps
    assert found.upright_at_end == pytest.approx((tilt[end] <= np.radians(20)).mean())
    assert found.diverged_at is None
    windows = measures.in_windows(trajectory, TOO_FAST)
    assert windows.swing_ups.sum() == found.swing_ups
    unstoppable = round((found.too_fast_share or 0.0) * found.swing_ups)
    assert windows.too_fast.sum() == unstoppable
    begins = np.flatnonzero(np.diff(above.astype(int), prepend=1) == -1)
    assert windows.excursions.sum() == len(begins)
    for w, (first, steps) in enumerate(zip(windows.first_step, windows.steps, strict=True)):
        assert windows.excursions[w] == ((first <= begins) & (begins < first + steps)).sum()
    rose = [(part <= np.radians(20)).any() for part in np.split(tilt, begins)[1:]]
    assert windows.recovered.sum() == sum(rose)
    assert windows.steps.sum() == 30_001
    assert windows.falls.sum() == found.falls
    for w, (first, steps) in enumerate(zip(windows.first_step, windows.steps, strict=True)):
        inside = slice(first, first + steps)
        assert windows.lowest_angle[w] == trajectory.angle[inside].min()
        assert windows.highest_angle[w] == trajectory.angle[inside].max()
        assert windows.upright_share[w] == pytest.approx((tilt[inside] <= np.radians(20)).mean())
        assert windows.highest_speed[w] == np.abs(trajectory.angular_velocity[inside]).max()


def first_stable_plainly(good, share):
    length = measures.STABLE_STEPS
    sums = np.convolve(good, np.ones(length), "valid")
    starts = np.flatnonzero(sums >= share * length - 1e-9)
    return int(starts[0]) if len(starts) else None


@settings(max_examples=60, deadline=None)
@given(st.lists(st.integers(0, 11_999), max_size=12))
def test_first_stable_step_of_balancing(resets):
    trajectory = made_of(np.zeros(12_000), resets)
    expected = first_stable_plainly(~trajectory.reset, 1.0)
    assert measures.measure(trajectory, True, TOO_FAST).first_stable_step == expected


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(st.booleans(), st.integers(1, 4_000)), min_size=1, max_size=8))
def test_first_stable_step_of_full_control(stretches):
    upright = np.concatenate([np.full(length, up) for up, length in stretches])
    trajectory = made_of(np.where(upright, 0.1, 3.0))
    long_enough = len(upright) >= measures.STABLE_STEPS
    expected = first_stable_plainly(upright, 0.9) if long_enough else None
    assert measures.measure(trajectory, False, TOO_FAST).first_stable_step == expected


def test_a_fall_is_a_passage_of_the_horizontal_from_above():
    trajectory = made_of(np.radians([0, 80, 100, 179, -179, -100, -80, -100, 0, 0]))
    assert measures.measure(trajectory, False, TOO_FAST).falls == 2


def test_turns_do_not_matter_to_what_is_upright():
    trajectory = made_of(np.array([0, 2 * np.pi, -4 * np.pi, 6 * np.pi + 0.1, np.pi] * 10))
    found = measures.measure(trajectory, False, TOO_FAST)
    assert found.upright_share == pytest.approx(0.8)


def test_the_last_fifth_is_the_last_fifth():
    assert [measures.last_fifth(n) for n in (1, 4, 5, 10, 50_000)] == [0, 3, 4, 8, 40_000]


def test_windows_of_a_control_have_no_td_error():
    trajectory = made_of(np.zeros(2_000))
    trajectory.td_error[:] = np.nan
    assert np.isnan(measures.in_windows(trajectory, TOO_FAST).mean_td_error).all()
