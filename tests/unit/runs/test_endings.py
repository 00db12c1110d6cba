"""How a run ended, over endings of several lengths, against plain numpy on every step."""

import numpy as np
import pytest

from tests.helpers import make_spec, run
from tests.unit.runs.test_metrics import TOO_FAST, made_of, plain
from upswing.physics.tasks import HORIZONTAL
from upswing.runs import metrics
from upswing.runs.endings import ENDINGS, PERCENT, endings
from upswing.runs.rows import collected
from upswing.runs.train import train
from upswing.study.measured import Measures

UPRIGHT = np.radians(20)


def plainly(trajectory, first):
    """The measures of all steps from one on."""
    tilt, above, fell = plain(trajectory)
    last = slice(first, None)
    arrives = ~above[:-1] & above[1:] & ~trajectory.reset[:-1]
    velocity = trajectory.angular_velocity.astype(float)
    before, after = tilt[:-1], tilt[1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = (before - HORIZONTAL) / (before - after)
    at_horizontal = np.abs(velocity[:-1] + share * np.diff(velocity))
    begins = np.flatnonzero(np.diff(above.astype(int), prepend=1) == -1)
    rose = np.array([(part <= UPRIGHT).any() for part in np.split(tilt, begins)[1:]], dtype=bool)
    own = begins >= first
    return {
        "falls_last_{}": fell[last].sum(),
        "upright_last_{}": (tilt[last] <= UPRIGHT).mean(),
        "mean_reward_last_{}": trajectory.reward[last].mean(dtype=float),
        "swing_ups_last_{}": arrives[last].sum(),
        "too_fast_last_{}": (arrives & (at_horizontal > TOO_FAST.rising))[last].sum(),
        "recovered_last_{}": rose[own].mean() if own.any() else None,
    }


def assert_alike(found, expected, what):
    if expected is None:
        assert found is None, what
    else:
        assert found == pytest.approx(expected, rel=1e-6), what


def going_round(steps, seed=3):
    """A made-up run that goes over the top again and again, at any speed."""
    random = np.random.default_rng(seed)
    trajectory = made_of(np.cumsum(random.normal(0, 0.5, steps)))
    trajectory.angular_velocity[:] = random.normal(0, 15, steps)
    trajectory.reward[:] = random.normal(size=steps)
    trajectory.reset[random.random(steps) < 0.001] = True
    return trajectory


def learned(kind, architecture):
    return lambda steps: run(make_spec(kind, architecture, 0.5, steps=steps))[0]


TRAJECTORIES = {
    "going round": going_round,
    "balancing": learned("balancing", "table"),
    "full control": learned("full-control", "table"),
    "random actions": learned("full-control", "random"),
    "no actions": learned("full-control", "idle"),
}


@pytest.mark.parametrize("name", TRAJECTORIES)
@pytest.mark.parametrize("steps", [20_000, 1_000])
def test_against_plain_numpy(name, steps):
    """Of runs of which an ending is a whole number of windows."""
    trajectory = TRAJECTORIES[name](steps)
    found = endings(metrics.in_windows(trajectory, TOO_FAST))
    expected = {
        name.format(percent): value
        for percent in PERCENT
        for name, value in plainly(trajectory, steps - steps * percent // 100).items()
    }
    assert found.keys() == expected.keys()
    for measure, value in expected.items():
        assert_alike(found[measure], value, measure)
    if name == "going round" and steps == 20_000:
        assert all(found.values())


@pytest.mark.parametrize("steps", [30_001, 12_345, 999])
def test_where_windows_are_no_whole_share_the_ending_begins_with_a_window(steps):
    trajectory = going_round(steps)
    windows = metrics.in_windows(trajectory, TOO_FAST)
    found = endings(windows)
    for percent in PERCENT:
        (first, *_) = windows.first_step[windows.first_step >= steps - steps * percent // 100]
        for name, value in plainly(trajectory, int(first)).items():
            assert_alike(found[name.format(percent)], value, name)


@pytest.mark.parametrize("name", TRAJECTORIES)
def test_the_last_20_per_cent_are_the_last_fifth(name):
    trajectory = TRAJECTORIES[name](20_000)
    measures = metrics.measure(trajectory, name == "balancing", TOO_FAST)
    found = endings(metrics.in_windows(trajectory, TOO_FAST))
    for measure, name in ENDINGS.items():
        if measure != "recovered_share":  # of excursions that began before it, too
            assert found[name.format(20)] == pytest.approx(getattr(measures, measure)), measure


@pytest.mark.parametrize("steps", [1, 2, 19, 20])
def test_of_the_shortest_runs_something_is_left(steps):
    trajectory = made_of(np.zeros(steps))
    found = endings(metrics.in_windows(trajectory, TOO_FAST))
    for percent in PERCENT:
        assert found[f"upright_last_{percent}"] == 1
        assert found[f"falls_last_{percent}"] == 0
        assert found[f"recovered_last_{percent}"] is None


def test_a_run_that_rises_late_stands_over_the_endings_since():
    angles = np.full(100_000, np.pi)
    angles[92_000:] = 0.1
    found = endings(metrics.in_windows(made_of(angles), TOO_FAST))
    shares = [found[f"upright_last_{percent}"] for percent in PERCENT]
    assert shares == pytest.approx([1.0, 0.8, 0.4, 8 / 30])


def test_they_are_columns_of_the_table_of_runs(tmp_path):
    spec = make_spec("balancing", "random", steps=2_000, seeds=(0, 1))
    train(spec, tmp_path)
    table = collected(tmp_path, [spec])
    for seed, row in zip(spec.seeds, table.to_dict("records"), strict=True):
        trajectory, _ = run(spec, seed)
        expected = plainly(trajectory, 1_800)
        for name in ("falls_last_{}", "upright_last_{}", "mean_reward_last_{}"):
            assert row[name.format(10)] == pytest.approx(expected[name], rel=1e-6), name
    assert set(ENDINGS) <= set(Measures._fields)
    names = {name.format(percent) for name in ENDINGS.values() for percent in PERCENT}
    assert names <= set(table.columns)
