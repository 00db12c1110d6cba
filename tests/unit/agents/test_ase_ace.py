"""The elements of 1983: step by step as printed, and they balance the pole of their paper and that of the thesis."""

from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import ValidationError

from tests.helpers import assert_same, beyond_spec, run
from tests.oracles import cart_pole, policies
from upswing.agents import algorithms, learners
from upswing.agents.features import locate
from upswing.agents.learners.ase_ace import NOISE, UNIT
from upswing.agents.policy import Rule
from upswing.runs.simulation import prepare
from upswing.study.architecture import architecture_of
from upswing.study.task import task_named

RULE = Rule(1.0, 0.95, 1.0, 1.0, 0.0, False)


def elements_spec(kind="balancing", steps=3_000, coding="boxes", **options):
    return beyond_spec(
        kind, 1, steps, epsilon=0.0, discount=0.95, learner="ase-ace", method="ase-ace",
        coding=coding, **options,
    )  # fmt: skip


@pytest.mark.parametrize(
    ("seed", "kind", "options"),
    [
        *((seed, "balancing", {}) for seed in (0, 1, 2)),
        (0, "balancing", {"reinforcement": "reward"}),
        (0, "full-control", {"reinforcement": "reward"}),
    ],
)
def test_as_printed(seed, kind, options):
    spec = elements_spec(kind, **options)
    encoder = prepare(spec, seed).encoder

    def box_of(state):
        return locate(encoder, state.angle, state.angular_velocity).tiles[0]

    trajectory, learned = run(spec, seed)
    taken, w, v = policies.ase_ace(
        seed, spec.task.steps, box_of, encoder.tiles, kind, told_reward=bool(options)
    )
    assert trajectory.action.tolist() == taken
    np.testing.assert_allclose(UNIT * learned["search"][0], w, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(learned["critic"][0], v, rtol=1e-9, atol=1e-12)
    assert kind == "full-control" or trajectory.reset.sum() >= 1
    assert np.abs(w).max() > 1


def test_balances_the_pole_of_1983_within_100_failures():
    """In the paper it does so for tens of thousands of steps, on average over ten runs."""
    longest = []
    for seed in range(10):
        encoder = SimpleNamespace(modules=1, tiles=cart_pole.BOXES)
        elements = learners.load("learners", "ase-ace").AseAceLearner(1, cart_pole.BOXES, 2)
        options = {"reinforcement": "failure"}
        design = algorithms.Design(encoder, 0.95, options, None, None, 2)
        lengths = np.zeros(100, dtype=np.int64)
        failures = cart_pole.trials(
            elements.stepped, algorithms.create("ase-ace", design), RULE,
            np.random.default_rng(seed), lengths, 100_000,
        )  # fmt: skip
        longest.append(100_000 if failures < 100 else lengths.max())
        assert lengths[:5].mean() < 200  # it could not do so from the beginning
    assert np.mean(longest) > 10_000
    assert sum(length == 100_000 for length in longest) >= 3


@pytest.mark.parametrize("seed", range(6))
def test_balances_the_pole_of_the_thesis_within_100_failures(seed):
    trajectory, _ = run(elements_spec(steps=50_000), seed)
    falls = np.flatnonzero(trajectory.reset)
    assert 1 <= len(falls) <= 100
    assert falls[-1] < 40_000


def test_boxes_are_cut_where_the_paper_cuts_them():
    encoder = prepare(elements_spec(), 0).encoder
    found = [
        locate(encoder, np.radians(angle), np.radians(speed)).tiles[0]
        for angle in (-80, -13, -7, -2, -0.5, 0.5, 2, 7, 13, 80)
        for speed in (-51, 0, 51)
    ]
    assert found == [*range(3), *range(24), *range(21, 24)]


def test_noise_decides_only_where_nothing_is_known():
    setting = prepare(elements_spec(), 0)
    elements = setting.learner.stepped

    def share_to_the_right(weight):
        q = (-weight, -abs(weight) - 1.0, weight)
        draws = np.linspace(0.0005, 0.9995, 1000)
        taken = {learners.choose(elements, q, setting.rule, draw) for draw in draws}
        assert taken <= {0, 2}
        return np.mean([learners.choose(elements, q, setting.rule, d) == 2 for d in draws])

    assert share_to_the_right(0.0) == pytest.approx(0.5, abs=1e-3)
    assert share_to_the_right(NOISE) == pytest.approx(0.8413, abs=2e-3)  # one standard deviation
    assert share_to_the_right(0.01) == 1
    assert share_to_the_right(-0.01) == 0


def test_a_run_in_pieces_and_one_in_plain_python_are_the_run_in_one(tmp_path):
    from tests.unit.runs.test_loop import assert_same_uncompiled

    spec = elements_spec(steps=1_000)
    (whole, learned), (pieces, again) = run(spec), run(spec, pieces=7)
    assert_same(whole, pieces)
    np.testing.assert_array_equal(learned["search"], again["search"])
    assert_same_uncompiled(spec, tmp_path)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"learner": "ase-ace", "method": "reinforce"}, "write `method: ase-ace`"),
        ({"learner": "softmax", "method": "ase-ace"}, "goes with `learner: ase-ace`"),
        ({"learner": "ase-ace", "method": "ase-ace", "coding": "tilings"}, "takes one tile"),
    ],
)
def test_what_does_not_go_together_is_refused(options, said):
    with pytest.raises(ValidationError, match=said):
        architecture_of(**options)


def test_without_falls_it_needs_another_reinforcement():
    task = task_named("full-control", kind="full-control", steps=10)
    keys = {"learner": "ase-ace", "method": "ase-ace"}
    assert "write `reinforcement: reward`" in "".join(architecture_of(**keys).misfits(task))
    assert not list(architecture_of(**keys, reinforcement="reward").misfits(task))
    endless, ended = ({"at_end": "falls"}, {"at_end": "falls", "limit": 2.0})
    for track, fits in ((endless, False), (ended, True)):
        other = task_named("full-control", kind="full-control", steps=10, track=track)
        assert (not list(architecture_of(**keys).misfits(other))) == fits
