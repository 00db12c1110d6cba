"""The greedy evaluation: what was learned, without exploring, and leaving it alone."""

import numpy as np
import pytest

from tests.helpers import beyond_spec, make_spec
from upswing.physics.environment import empty_trajectory
from upswing.runs.evaluation import evaluate
from upswing.runs.simulation import prepare


def learned(spec, seed=0):
    setting = prepare(spec, seed)
    setting.advance(empty_trajectory(spec.task.steps), 0, spec.task.steps)
    return setting


@pytest.mark.parametrize("architecture", ["table", "modular-networks-5", "networks-20-5"])
def test_what_was_learned_stays_as_it_is(architecture):
    spec = make_spec("full-control", architecture, 0.5, 3_000, hand_over="own")
    setting = learned(spec)
    before = {name: values.copy() for name, values in setting.learner.learned.items()}
    state, draw = setting.state, setting.actions.bit_generator.state
    first = evaluate(setting, spec, 0)
    assert evaluate(setting, spec, 0) == first
    for name, values in setting.learner.learned.items():
        np.testing.assert_array_equal(values, before[name])
    assert setting.state == state
    assert setting.actions.bit_generator.state == draw


def test_a_table_that_has_learned_balances_from_everywhere():
    spec = make_spec("balancing", "table", 0.1, 20_000)
    found = evaluate(learned(spec), spec, 0)
    assert found.greedy_success_share == 1
    assert found.greedy_upright_share > 0.9


def test_without_control_only_the_upright_start_stays_up():
    spec = make_spec("balancing", "idle", None, 100)
    found = evaluate(learned(spec), spec, 0)
    assert found.greedy_success_share == pytest.approx(1 / 9)


def test_a_fresh_table_swings_nothing_up():
    spec = make_spec("full-control", "table")
    found = evaluate(prepare(spec, 0), spec, 0)
    assert found.greedy_success_share == 0


@pytest.mark.parametrize("name", ["gated", "decaying"])
def test_so_does_what_learners_count_whatever_the_step_size(name):
    options = {"halved_after": 5.0} if name == "decaying" else {}
    spec = beyond_spec(learner=name, **options)
    setting = learned(spec)
    before = {name: values.copy() for name, values in setting.learner.learned.items()}
    evaluate(setting, spec, 0)
    for name, values in setting.learner.learned.items():
        np.testing.assert_array_equal(values, before[name])
