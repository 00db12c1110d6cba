"""The loop: against a plain transcription of the thesis, against itself uncompiled, and identities."""

import json
import os
import subprocess
import sys

import numpy as np
import pytest

from tests.helpers import ARCHITECTURES, assert_same, make_spec, run
from tests.oracles.transcription import transcribe
from tests.paths import ROOT
from upswing.physics.environment import empty_trajectory
from upswing.runs.simulation import prepare
from upswing.runs.train import learn
from upswing.study.readings import Readings

CASES = [
    *(("balancing", name, {}) for name in ARCHITECTURES),
    *(("full-control", name, {}) for name in ARCHITECTURES),
    ("balancing", "table", {"zero_of_angle": "hanging"}),
    ("balancing", "table", {"angle_unit": "radians"}),
    ("full-control", "modular-table", {"angle_unit": "radians"}),
    ("full-control", "table", {"wrap": "unbounded"}),
    ("full-control", "modular-networks-5", {"wrap": "unbounded"}),
    ("balancing", "table", {"first_q": "pessimistic"}),
    ("balancing", "table", {"first_q": "random"}),
    ("balancing", "table", {"ties": "first"}),
    ("balancing", "table", {"reset": "terminal"}),
    ("balancing", "table", {"reset": "reset"}),
    ("balancing", "table", {"reset": "reset", "reward_state": "current"}),
    ("balancing", "table", {"start_velocity": "random"}),
    ("balancing", "table", {"reward_state": "current"}),
    ("full-control", "table", {"reward_unit": "radians"}),
    ("balancing", "networks-5", {"reward_unit": "degrees", "learning_rate": 0.03}),
    ("balancing", "networks-5", {"biases": "hidden"}),
    ("full-control", "networks-20-5", {"biases": "both"}),
    ("full-control", "modular-networks-5", {"biases": "both", "hand_over": "own"}),
    ("balancing", "networks-5", {"error_sign": "printed"}),
    ("full-control", "modular-table", {"hand_over": "own"}),
    ("full-control", "modular-table", {"hand_over": "terminal"}),
    ("balancing", "modular-table", {"hand_over": "own"}),
    ("balancing", "modular-table", {"hand_over": "own", "reset": "terminal"}),
    ("full-control", "modular-networks-5", {"hand_over": "own"}),
    ("full-control", "modular-networks-5", {"hand_over": "terminal"}),
]


NETWORKS_AGREE = {"degrees": 200}
"""Networks agree to the last digits but one, which grow with the errors; so many steps are the same."""


@pytest.mark.parametrize("alpha", [1, 0.1])
@pytest.mark.parametrize(("kind", "architecture", "readings"), CASES, ids=str)
def test_same_trajectory_as_the_transcription(kind, architecture, readings, alpha):
    # Networks are chaotic: rounding (a sum in another order) grows from step to step.
    table = ARCHITECTURES[architecture]["learner"] != "networks"
    spec = make_spec(
        kind,
        architecture,
        alpha,
        steps=2_500 if table else NETWORKS_AGREE.get(readings.get("reward_unit"), 250),
        **readings,
    )
    for seed in (0, 1):
        learner = prepare(spec, seed).learner
        columns = transcribe(spec, seed, {k: v.copy() for k, v in learner.learned.items()})
        trajectory = learn(spec, seed, empty_trajectory(spec.task.steps)).trajectory
        np.testing.assert_array_equal(trajectory.action, columns["action"])
        np.testing.assert_array_equal(trajectory.reset, columns["reset"])
        for name in ("angle", "angular_velocity", "reward"):
            np.testing.assert_allclose(
                getattr(trajectory, name), columns[name], rtol=2e-5, atol=2e-5, err_msg=name
            )
        if alpha is not None and ARCHITECTURES[architecture]["learner"] != "control":
            np.testing.assert_allclose(
                trajectory.td_error, columns["td_error"], rtol=1e-4, atol=1e-4
            )


UNCOMPILED = """
import json, sys
import numpy as np
from tests.helpers import run
from upswing.study.spec import parse
trajectory, learned = run(parse(sys.argv[1]))
np.savez(sys.argv[2], **trajectory._asdict(), **{f"learned.{k}": v for k, v in learned.items()})
"""


@pytest.mark.parametrize("architecture", ["table", "modular-networks-5", "networks-20-5", "random"])
def test_compiled_and_plain_python_are_the_same_to_the_last_bit(architecture, tmp_path):
    spec = make_spec("full-control", architecture, 0.5, steps=1_500, hand_over="own", biases="both")
    assert_same_uncompiled(spec, tmp_path)


def assert_same_uncompiled(spec, tmp_path):
    subprocess.run(
        [sys.executable, "-c", UNCOMPILED, spec.canonical(), str(tmp_path / "plain.npz")],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        cwd=ROOT,
        check=True,
    )
    trajectory, learned = run(spec)
    with np.load(tmp_path / "plain.npz") as plain:
        for name, column in trajectory._asdict().items():
            np.testing.assert_array_equal(plain[name], column, err_msg=name)
        for name, values in learned.items():
            np.testing.assert_array_equal(plain[f"learned.{name}"], values, err_msg=name)


@pytest.mark.parametrize("architecture", ["table", "modular-table", "networks-5", "networks-20-5"])
def test_the_same_seed_gives_the_same_run(architecture):
    spec = make_spec("full-control", architecture, 0.5)
    (one, learned), (other, again) = run(spec, 3), run(spec, 3)
    assert_same(one, other)
    for name in learned:
        np.testing.assert_array_equal(learned[name], again[name])


def test_a_run_in_pieces_is_the_run_in_one():
    spec = make_spec("full-control", "modular-table", 0.5, hand_over="own")
    (whole, learned), (pieces, again) = run(spec), run(spec, pieces=7)
    assert_same(whole, pieces)
    np.testing.assert_array_equal(learned["q"], again["q"])


def test_different_seeds_differ_in_start_exploration_and_weights():
    spec = make_spec("full-control", "networks-5")
    first = [prepare(spec, seed).learner.learned["weights.0"] for seed in (0, 1)]
    assert (first[0] != first[1]).mean() > 0.99
    random = make_spec("full-control", "random")
    (one, _), (other, _) = run(random, 0), run(random, 1)
    assert one.angle[0] != other.angle[0]
    assert (one.action != other.action).mean() == pytest.approx(2 / 3, abs=0.05)


def test_cells_with_the_same_seed_share_starts_and_exploration():
    table, networks = make_spec("balancing", "table"), make_spec("balancing", "networks-5")
    (one, _), (other, _) = run(table), run(networks)
    starts = [np.concatenate([t.angle[:1], t.angle[1:][t.reset[:-1]]]) for t in (one, other)]
    common = min(map(len, starts))
    assert common > 5
    np.testing.assert_array_equal(starts[0][:common], starts[1][:common])


@pytest.mark.parametrize("alpha", [1, 0.5, 0.001])
def test_r14_two_tables_are_one_table_under_another_name(alpha):
    one, _ = run(make_spec("full-control", "table", alpha, steps=100_000))
    two, _ = run(make_spec("full-control", "modular-table", alpha, steps=100_000))
    assert_same(one, two)


@pytest.mark.parametrize("kind", ["balancing", "full-control"])
@pytest.mark.parametrize("first_q", ["zero", "pessimistic", "random"])
def test_r3_a_scale_of_the_reward_changes_nothing_for_a_table(kind, first_q):
    units = ("half_turn", "radians")  # 4 and 1: the scale is a power of 2, so rounding is the same
    one, other = (
        run(make_spec(kind, "table", 0.75, 50_000, reward_unit=unit, first_q=first_q))[0]
        for unit in units
    )
    assert_same(one, other)


def test_r3_degrees_differ_from_radians_by_rounding_alone():
    one, other = (
        run(make_spec("balancing", "table", 0.5, 5_000, reward_unit=unit))[0]
        for unit in ("radians", "degrees")
    )
    np.testing.assert_array_equal(one.action, other.action)
    np.testing.assert_allclose(one.td_error, other.td_error, rtol=1e-5, atol=1e-7)


OPTIONS = [
    (name, option)
    for name, field in Readings.model_json_schema()["properties"].items()
    for option in field.get("enum", [])
    if option != field["default"]
]
WITHOUT_EFFECT_ON_TABLES = {("reward_unit", "radians"), ("reward_unit", "degrees")}


@pytest.mark.parametrize(("name", "option"), OPTIONS, ids=str)
def test_every_option_of_every_reading_changes_a_run_it_touches(name, option):
    changed = 0
    for kind in ("balancing", "full-control"):
        for architecture in ("table", "modular-table", "networks-5", "modular-networks-5"):
            base = make_spec(kind, architecture, 0.5, steps=3_000)
            other = make_spec(kind, architecture, 0.5, steps=3_000, **{name: option})
            (a, _), (b, _) = run(base), run(other)
            differs = any((x != y).any() for x, y in zip(a[:5], b[:5], strict=True))
            in_spec = base.canonical() != other.canonical()
            assert in_spec or not differs, f"{name} changes {kind}/{architecture} unsaid"
            changed += differs
    assert changed, f"{name}={option} changes nothing"


def test_pessimistic_first_q_is_the_lowest_return():
    spec = make_spec("full-control", first_q="pessimistic", reward_unit="radians")
    learner = prepare(spec, 0).learner
    np.testing.assert_allclose(learner.learned["q"], -(np.pi**2) / 0.3)


def test_the_controls_do_what_they_are_named_after():
    idle, _ = run(make_spec("full-control", "idle", steps=5_000))
    assert (idle.action == 1).all()
    assert (idle.cart_velocity == 0).all()
    random, _ = run(make_spec("full-control", "random", steps=30_000))
    assert np.bincount(random.action) / 30_000 == pytest.approx([1 / 3] * 3, abs=0.01)


def test_a_control_has_no_td_error():
    spec = make_spec("balancing", "random")
    assert np.isnan(learn(spec, 0, empty_trajectory(2_000)).trajectory.td_error).all()


def test_the_cart_is_simulated_and_starts_anew_after_a_fall():
    trajectory, _ = run(make_spec("balancing", "table"))
    accelerations = np.array([-10.0, 0.0, 10.0])[trajectory.action]
    position = velocity = 0.0
    for t in range(2_000):
        assert trajectory.cart_position[t] == pytest.approx(position, abs=1e-4)
        assert trajectory.cart_velocity[t] == pytest.approx(velocity, abs=1e-5)
        velocity += accelerations[t] * 0.005
        position += velocity * 0.005
        if trajectory.reset[t]:
            position = velocity = 0.0
    assert trajectory.reset.any()


def test_learning_on_a_table_balances():
    """With α = 0.1 every run of the thesis's table balances: a broken loop would not."""
    falls = [run(make_spec("balancing", "table", 0.1, 20_000), seed)[0].reset[-5_000:].sum()
             for seed in range(5)]  # fmt: skip
    assert falls == [0] * 5


def test_specs_name_each_case_once():
    assert len({json.dumps(case) for case in CASES}) == len(CASES)
