"""What a run learned, read back: it evaluates, answers and moves as the run itself did."""

import json
import struct
from dataclasses import replace

import numpy as np
import pytest
from safetensors.numpy import save_file

from tests.helpers import assert_same, beyond_spec, make_spec
from upswing.agents.features import locate
from upswing.physics.environment import State, empty_trajectory
from upswing.runs.evaluation import evaluate
from upswing.runs.files.trajectory import read_metadata
from upswing.runs.learned import Learned, learned_by, load_learned
from upswing.runs.simulation import new_algorithm, prepare, streams
from upswing.runs.train import train
from upswing.study.errors import BadInput
from upswing.study.ids import file_of

OWN = {"length": 0.4, "time_step": 0.01, "accelerations": (-20, -10, 0, 10, 20)}

SPECS = {
    "table": make_spec("balancing", "table", 0.5, 6_000),
    "table, first of equals": make_spec("full-control", "table", 0.5, 2_000, ties="first"),
    "modular table": make_spec("full-control", "modular-table", 0.1, 6_000),
    "networks": make_spec("balancing", "networks-5", 1, 6_000),
    "two hidden layers, biases": make_spec(
        "full-control", "networks-20-5", 1, 4_000, biases="both"
    ),
    "modular networks, turns counted": make_spec(
        "full-control", "modular-networks-5", 1, 4_000, wrap="unbounded"
    ),
    "random": make_spec("full-control", "random", None, 500),
    "push": make_spec("balancing", "idle", None, 500),
    "tilings": beyond_spec(coding="tilings", alpha=0.1, readings={"ties": "first"}),
    "decaying": beyond_spec(learner="decaying", halved_after=100.0, method="sarsa"),
    "networks of the state": beyond_spec(learner="networks", coding="continuous", hidden=(8,)),
    "action among the inputs": beyond_spec(learner="action-input", hidden=(8,)),
    "bells": beyond_spec(learner="linear", coding="radial", width=0.8),
    "bells that move": beyond_spec(
        learner="radial-network", coding="continuous", hidden=(8,), method="sarsa-lambda", trace=0.7
    ),
    "another pendulum": beyond_spec(task={"pendulum": OWN, "track": {"limit": 0.5}}),
    "five networks": beyond_spec(task={"pendulum": OWN}, learner="networks", hidden=(8,)),
    "dqn": beyond_spec(learner="dqn", coding="continuous", hidden=(16,), alpha=0.001),
    "dqn-sb3": beyond_spec(learner="dqn-sb3", coding="continuous", hidden=(16,), alpha=0.001),
}


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """A folder with a run of each specification, and the name of each."""
    folder = tmp_path_factory.mktemp("learned")
    for name, spec in SPECS.items():
        train(spec, folder / name)
    return folder


def loaded(stored, name):
    return learned_by(stored / name, SPECS[name].run(0))


@pytest.mark.parametrize("name", SPECS)
def test_the_frozen_evaluation_comes_out_as_it_is_stored(stored, name):
    outcome = read_metadata(stored / name / file_of(SPECS[name].run(0), "windows.parquet"))[
        "outcome"
    ]
    learned = loaded(stored, name)
    assert learned.spec == SPECS[name].of_seed(0)
    found = evaluate(learned.setting, learned.spec, learned.seed)
    assert found._asdict() == {key: outcome[key] for key in found._fields}


FOLLOWED = (
    "table", "modular table", "networks", "tilings", "dqn", "dqn-sb3", "random", "another pendulum",
)  # fmt: skip


@pytest.mark.parametrize("name", FOLLOWED)
def test_following_is_what_the_evaluation_does(stored, name):
    """The oracle is the evaluation's own way to freeze a run that has learned."""
    spec, steps = SPECS[name], 1_500
    setting = prepare(spec, 0)
    setting.advance(empty_trajectory(spec.task.steps), 0, spec.task.steps)
    *_, stream, decisions = streams(0)
    own = setting.learner.epsilon
    frozen = replace(
        setting,
        rule=setting.rule._replace(step_size=0.0, epsilon=0.0 if own is None else own),
        state=State(0.3, 0.0, 0.0, 0.0),
        algorithm=new_algorithm(spec, setting.encoder, setting.learner, decisions),
        actions=stream,
        starts=stream,
    )
    expected = empty_trajectory(steps)
    frozen.advance(expected, 0, steps)
    assert_same(loaded(stored, name).simulate(0.3, 0.0, steps), expected)


@pytest.mark.parametrize(
    "name", ["table, first of equals", "networks", "tilings", "dqn", "dqn-sb3", "five networks"]
)
def test_the_policy_is_the_action_of_the_largest_value(stored, name):
    learned, draws = loaded(stored, name), np.random.default_rng(1)
    angle, velocity = draws.uniform(-1.5, 1.5, (3, 40)), draws.uniform(-10, 10, (3, 40))
    q = learned.values(angle, velocity)
    actions = len(SPECS[name].task.pendulum.accelerations)
    assert q.shape == (3, 40, actions)
    np.testing.assert_array_equal(
        learned.policy(angle, velocity), np.array(learned.accelerations)[q.argmax(axis=-1)]
    )
    places = [
        locate(learned.setting.encoder, *state)
        for state in zip(angle.ravel().tolist(), velocity.ravel().tolist(), strict=True)
    ]
    told = learned.setting.learner.action_values(places)
    rtol, atol = (1e-5, 1e-4) if name == "dqn-sb3" else (1e-12, 1e-14)  # it has float32
    np.testing.assert_allclose(q.reshape(-1, actions), told, rtol=rtol, atol=atol)
    assert learned.policy(0.1, 0.2).shape == ()
    assert learned.policy(0.1, velocity).shape == (3, 40)


def test_without_a_length_it_is_followed_for_20_s(stored):
    assert len(loaded(stored, "table").simulate(0.2).angle) == 4_000
    assert len(loaded(stored, "another pendulum").simulate(0.2).angle) == 2_000


def test_the_policy_answers_as_the_run_acts(stored):
    """Along a path on which no two values are equal, its answers are the actions taken."""
    learned = loaded(stored, "networks")
    path = learned.simulate(0.2, 0.0, 400)
    asked = learned.policy(path.angle.astype(float), path.angular_velocity.astype(float))
    np.testing.assert_array_equal(asked, np.array(learned.accelerations)[path.action])


def test_among_equals_the_reading_decides():
    many = np.zeros(3_000)
    for ties, expected in (("random", {-10.0, 0.0, 10.0}), ("first", {-10.0})):
        spec = make_spec("full-control", "table", 0.5, 100, ties=ties)
        learned = Learned(spec, prepare(spec, 0).learner.learned)
        answer = learned.policy(many, many)
        assert set(answer) == expected
        np.testing.assert_array_equal(answer, learned.policy(many, many))


def test_full_control_knows_no_number_of_turns(stored):
    learned = loaded(stored, "modular table")
    angles = np.linspace(-3, 3, 50)
    q = learned.values(angles, 1.0)
    np.testing.assert_array_equal(learned.values(angles + 4 * np.pi, 1.0), q)
    assert len(np.unique(q, axis=0)) > 3


def test_a_push_changes_the_velocity_where_it_is_asked_for(stored):
    learned = loaded(stored, "table")
    pushed, plain = learned.simulate(0.1, 0, 600, {200: 0.5}), learned.simulate(0.1, 0, 600)
    np.testing.assert_array_equal(pushed.angle[:201], plain.angle[:201])
    assert pushed.angular_velocity[200] == pytest.approx(plain.angular_velocity[200] + 0.5)
    assert pushed.angle[201] != plain.angle[201]


def test_asking_and_following_change_nothing_that_was_learned(stored):
    learned = loaded(stored, "modular table")
    before = {name: array.copy() for name, array in learned.arrays.items()}
    learned.policy(np.linspace(-3, 3, 9), 0.0)
    assert_same(learned.simulate(3.0, 0, 800), learned.simulate(3.0, 0, 800))
    for name, array in learned.arrays.items():
        np.testing.assert_array_equal(array, before[name])


# Files that are not as they should be.

SPEC = SPECS["table"].of_seed(0)
Q = {"q": np.zeros((1, 80, 3))}


def text(**changes):
    return json.dumps({**json.loads(SPEC.canonical()), **changes})


def no_safetensors(path):
    path.write_bytes(struct.pack("<Q", 4) + b"nope")


def a_huge_header(path):
    path.write_bytes(struct.pack("<Q", 1 << 40) + b"{}")


def cut(path):
    save_file(Q, path, {"spec": SPEC.canonical()})
    path.write_bytes(path.read_bytes()[:-100])


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda _: None, "missing"),
        (lambda path: path.write_bytes(b""), "no file of weights"),
        (no_safetensors, "cannot be read"),
        (a_huge_header, "no file of weights: its header would have 1,099,511,627,776 bytes"),
        (cut, "cannot be read"),
        (lambda path: save_file(Q, path), "there is no `spec`"),
        (lambda path: save_file(Q, path, {"spec": "{"}), "is not JSON"),
        (lambda path: save_file(Q, path, {"spec": text(gamma=1)}), "gamma"),
        (lambda path: save_file(Q, path, {"spec": text(seeds=[1, 2])}), "weights are of one run"),
        (
            lambda path: save_file({"p": Q["q"]}, path, {"spec": SPEC.canonical()}),
            "holds p; table has q",
        ),
        (
            lambda path: save_file({"q": np.zeros((1, 3))}, path, {"spec": SPEC.canonical()}),
            "q: has shape (1, 3) of float64; table has (1, 80, 3) of float64",
        ),
        (
            lambda path: save_file(
                {"q": Q["q"].astype("float32")}, path, {"spec": SPEC.canonical()}
            ),
            "of float32",
        ),
    ],
)
def test_a_file_that_is_none_is_named_with_what_is_wrong(tmp_path, make, says):
    path = tmp_path / "own.weights.safetensors"
    make(path)
    with pytest.raises(BadInput) as raised:
        load_learned(path)
    (problem,) = raised.value.problems
    assert str(path) in problem
    assert says in problem


def test_weights_of_another_run_are_not_taken(tmp_path):
    run = SPEC.run(1)
    path = tmp_path / file_of(run, "weights.safetensors")
    path.parent.mkdir(parents=True)
    save_file(Q, path, {"spec": SPEC.canonical()})
    with pytest.raises(BadInput, match=f"is of {SPEC.run(0)}"):
        learned_by(tmp_path, run)
    assert load_learned(path).run == SPEC.run(0)
