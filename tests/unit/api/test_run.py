"""A run: what is stored of it, what it learned, and learning it again bit for bit."""

import shutil

import numpy as np
import pandas as pd
import pytest
from safetensors.numpy import load_file, save_file

import upswing
from tests.helpers import run
from tests.unit.api.said import says
from upswing.runs.files.trajectory import OF_A_TRAJECTORY, OF_WINDOWS
from upswing.runs.files.typed_table import read_table
from upswing.study.ids import file_of
from upswing.study.spec import parse

RUNS = (
    "balancing/table/alpha-0.1/seed-1",
    "full-control/modular-networks-5/alpha-1/seed-2",
    "balancing/idle/alpha-none/seed-0",
)


@pytest.mark.parametrize("name", RUNS)
def test_what_is_stored_of_it_is_read(study, results, name):
    one = study.run(name)
    for kind, frame, columns in (
        ("trajectory.parquet", one.trajectory, OF_A_TRAJECTORY),
        ("windows.parquet", one.windows, OF_WINDOWS),
    ):
        path = results.folder / file_of(name, kind)
        pd.testing.assert_frame_equal(frame, read_table(path, columns, ""))
    assert one.trajectory.attrs["units"]["angular_velocity"] == "rad/s"
    row = study.runs.set_index("run").loc[name]
    assert {key: one.measures[key] for key in ("falls", "digest", "seed")} == {
        key: row[key] for key in ("falls", "digest", "seed")
    }
    assert one.recording == results.folder / file_of(name, "rrd")
    weights = load_file(results.folder / file_of(name, "weights.safetensors"))
    assert set(one.weights) == set(weights)
    for key, array in weights.items():
        np.testing.assert_array_equal(one.weights[key], array)


def test_it_says_what_it_is(study):
    one = study.run(RUNS[0])
    assert repr(one) == f"<run {RUNS[0]}, as it is stored>"
    shown = one._repr_html_()
    assert f"<td>{int(one.measures['falls']):,}</td>" in shown
    assert len(shown) < 1_000


@pytest.mark.parametrize("name", RUNS)
def test_learned_again_it_is_the_same(study, name):
    """Every step is held against a run that the loop made by itself."""
    again = study.run(name).replay()
    assert repr(again) == f"<run {name}, learned again: bit for bit the same>"
    expected, _ = run(again.spec, again.seed)
    whole = again.trajectory
    assert list(whole["step"]) == list(range(again.task.steps))
    for column in ("angle", "angular_velocity", "cart_position", "action", "reward", "reset"):
        np.testing.assert_array_equal(whole[column], getattr(expected, column))
    stored = study.run(name)
    pd.testing.assert_frame_equal(again.windows, stored.windows)
    pd.testing.assert_frame_equal(
        whole.iloc[stored.trajectory["step"]].reset_index(drop=True), stored.trajectory
    )
    for key, array in stored.weights.items():
        np.testing.assert_array_equal(again.weights[key], array)
    ours, theirs = again.measures, stored.measures
    same = [key for key in ours.index if not key.startswith(("seconds", "steps_per_second"))]
    pd.testing.assert_series_equal(ours[same], theirs[same], check_names=False)
    assert again.recording is None


@pytest.fixture
def copied(results, tmp_path):
    shutil.copytree(results.folder, tmp_path / "results")
    return tmp_path / "results"


def test_a_step_that_differs_is_said(copied):
    path = copied / file_of(RUNS[0], "trajectory.parquet")
    frame = pd.read_parquet(path)
    frame.loc[700, "angle"] = np.nextafter(frame.loc[700, "angle"], np.float32(9))
    frame.to_parquet(path)
    with pytest.raises(upswing.DifferentRun, match="first in step 700: angle"):
        upswing.open(copied).run(RUNS[0]).replay()


def test_weights_that_differ_are_said(copied):
    path = copied / file_of(RUNS[0], "weights.safetensors")
    one = upswing.open(copied).run(RUNS[0])
    q = load_file(path)["q"]
    q[0, 3, 1] += 1e-9
    save_file({"q": q}, path, {"spec": one.spec.canonical()})
    with pytest.raises(upswing.DifferentRun, match="first in the weights: q"):
        one.replay()


def test_files_that_are_missing_are_said(copied):
    one = upswing.open(copied).run(RUNS[0])
    for kind in ("trajectory.parquet", "windows.parquet", "weights.safetensors", "rrd"):
        (copied / file_of(RUNS[0], kind)).unlink()
    assert one.recording is None
    for read in (
        lambda: one.trajectory,
        lambda: one.windows,
        lambda: one.measures,
        lambda: one.policy,
    ):
        assert "missing" in says(read)


def test_weights_of_other_readings_are_not_taken(copied):
    one = upswing.open(copied).run(RUNS[0])
    path = copied / file_of(RUNS[0], "weights.safetensors")
    other = one.spec.model_copy(update={"discount": 0.9})
    save_file(load_file(path), path, {"spec": other.canonical()})
    assert "of another specification" in says(lambda: one.policy)


# What it learned.


def test_the_policy_answers_numbers_and_arrays(study):
    policy = study.run(RUNS[0]).policy
    q = policy.values(0.05, -0.2)
    assert isinstance(policy(0.05, -0.2), float)
    assert policy(0.05, -0.2) == (-10.0, 0.0, 10.0)[int(q.argmax())]
    angles = np.linspace(-1, 1, 21)
    found = policy(angles[:, None], np.zeros(5))
    assert found.shape == (21, 5)
    assert set(np.unique(found)) <= {-10.0, 0.0, 10.0}
    assert policy.values(angles, 0.0).shape == (21, 3)
    assert "could not convert" in says(lambda: policy("up", 0))
    assert "shape" in says(lambda: policy([1, 2], [1, 2, 3]))
    assert "must be finite" in says(lambda: policy(float("nan"), 0))
    assert "must be finite" in says(lambda: policy.values(0, [0, float("inf")]))


def test_a_policy_is_loaded_from_its_file_alone(study, results, tmp_path):
    one = study.run(RUNS[1])
    moved = tmp_path / "mine.safetensors"
    shutil.copy(results.folder / file_of(RUNS[1], "weights.safetensors"), moved)
    policy = upswing.load(str(moved))
    assert policy.run == RUNS[1]
    assert parse(policy.spec.canonical()) == one.spec
    angles = np.linspace(-3, 3, 50)
    np.testing.assert_array_equal(policy(angles, 1.0), one.policy(angles, 1.0))
    assert "missing" in says(lambda: upswing.load(tmp_path / "other"))


def test_a_simulation_follows_the_policy(study):
    one = study.run(RUNS[0])
    path = one.simulate(0.1, seconds=2)
    assert len(path) == 400
    assert path["time"].iloc[1] == 0.005
    assert path.attrs["units"]["acceleration"] == "m/s²"
    assert path["angle"].iloc[0] == np.float32(0.1)
    falls = int(path["reset"].idxmax()) if path["reset"].any() else 400
    q = one.values(path["angle"].to_numpy(float), path["angular_velocity"].to_numpy(float))
    clear = np.sort(q, axis=-1)[:, -1] > np.sort(q, axis=-1)[:, -2]
    clear[falls:] = False
    asked = one.policy(path["angle"].to_numpy(float), path["angular_velocity"].to_numpy(float))
    assert clear.sum() > 20
    # A stored state is rounded to 32 bits, which may lie beyond the border of a tile.
    assert (asked == path["acceleration"])[clear].mean() > 0.95


def test_a_simulation_begins_where_the_evaluation_does(study):
    assert study.run(RUNS[1]).simulate(seconds=0.1)["angle"].iloc[0] == np.float32(-np.pi)
    assert study.run(RUNS[0]).simulate(seconds=0.1)["angle"].iloc[0] == np.float32(np.radians(-20))
    round_again = study.run(RUNS[1]).simulate(2 * np.pi + 0.5, seconds=0.1)
    assert round_again["angle"].iloc[0] == pytest.approx(0.5)


def test_a_push_comes_when_it_is_asked_for(study):
    one = study.run(RUNS[1])
    plain, pushed = one.simulate(seconds=3), one.simulate(seconds=3, pushes={1.0: 2.0})
    assert plain.iloc[:200].equals(pushed.iloc[:200])
    change = pushed["angular_velocity"].iloc[200] - plain["angular_velocity"].iloc[200]
    assert change == pytest.approx(2.0, abs=1e-5)


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"angle": 3.0}, "simulate: angle: 3.0: must be within ±1.5708 rad"),
        ({"angle": float("nan")}, "must be a number"),
        ({"angular_velocity": float("inf")}, "must be a number"),
        ({"seconds": 0}, "simulate: seconds: 0: must be between 0.005 and"),
        ({"seconds": 2, "pushes": {2.0: 1}}, "must be seconds within the time"),
    ],
)
def test_a_simulation_that_cannot_be_is_said(study, asked, said):
    assert said in says(lambda: study.run(RUNS[0]).simulate(**asked))


# Training.


def test_what_is_trained_here_is_the_run_of_the_study(study):
    stored = study.run(RUNS[0])
    by_study = study.train("balancing", "table", 0.1, 1)
    by_name = upswing.train("balancing", "table", 0.1, 1, steps=7_000)
    by_keys = upswing.train(
        {"name": "balancing", "kind": "balancing", "steps": 7_000},
        {"name": "table", "learner": "table"}, 0.1, 1, epsilon=0.01, discount=0.7,
    )  # fmt: skip
    for one in (by_study, by_name, by_keys):
        assert one.spec == stored.spec
        assert one.measures["digest"] == stored.measures["digest"]
        assert repr(one) == f"<run {RUNS[0]}, learned here>"
    assert by_name.replay().id == stored.id


def test_a_control_is_trained_without_an_alpha(study):
    one = study.train("balancing", "idle", seed=2)
    assert one.measures["digest"] == study.run("balancing/idle/alpha-none/seed-2").measures["digest"]  # fmt: skip


def test_what_is_given_takes_the_place_of_what_is_known():
    one = upswing.train(
        "full-control", {"learner": "networks", "hidden": [4], "discount": 0.8}, 0.5, 7, steps=300,
        epsilon=0.2, discount=0.9, readings={"ties": "first"},
    )  # fmt: skip
    assert one.id == "full-control/own/alpha-0.5/seed-7"
    assert (one.spec.epsilon, one.spec.discount, one.spec.readings.ties) == (0.2, 0.9, "first")
    assert one.spec.architecture.model_dump()["hidden"] == (4,)
    assert len(one.trajectory) == 300
    kept = upswing.train("full-control", {"learner": "table", "discount": 0.8}, 0.5, steps=100)
    assert kept.spec.discount == 0.8


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (("balance", "table", 1), "train: task: \"balance\": did you mean 'balancing'?"),
        (("balancing", "tabel", 1), "train: architecture: \"tabel\": did you mean 'table'?"),
        (("balancing", "table"), "train: alpha: missing: table learns with an α in (0, 1]"),
        (("balancing", "table", 2), "train: alpha: 2: must be less than or equal to 1"),
        (("balancing", "idle", 1), "train: alpha: [1.0]: idle does not learn"),
        (("balancing", "table", 1, -1), "train: seed: -1: must be greater than or equal to 0"),
        (("balancing", "table", 1, 0, 0), "train: tasks.balancing.steps: 0: must be"),
        (
            ("balancing", {"learner": "table", "hiden": 3}, 1),
            "train: architectures.own.hiden: unknown key",
        ),
        (({"kind": "balanc", "steps": 9}, "table", 1), "did you mean 'balancing'?"),
    ],
)
def test_what_cannot_be_trained_is_said_as_it_was_asked(asked, said):
    assert said in says(lambda: upswing.train(*asked))


@pytest.mark.parametrize(
    ("pendulum", "said"),
    [
        ({"lenght": 1}, "train: tasks.balancing.pendulum.lenght: unknown key"),
        ({"length": 0}, "train: tasks.balancing.pendulum.length: 0: must be"),
        ({"accelerations": [1, 2]}, "at least one must be negative and one positive"),
    ],
)
def test_a_pendulum_that_cannot_be_is_said(pendulum, said):
    assert said in says(lambda: upswing.train("balancing", "table", 1, pendulum=pendulum))


OWN = {"length": 0.4, "time_step": 0.01, "accelerations": [-20, -10, 0, 10, 20]}


def test_another_pendulum_is_trained_asked_and_followed():
    one = upswing.train("full-control", "table", 0.5, steps=600, pendulum=OWN)
    pushes = (-20.0, -10.0, 0.0, 10.0, 20.0)
    assert one.policy.accelerations == pushes
    assert one.spec.task.pendulum.mass == 0.1  # as the task has it
    angles = np.linspace(-3, 3, 200)
    assert one.values(angles, 1.0).shape == (200, 5)
    assert set(one.policy(angles, 1.0)) <= set(pushes)
    assert str(pushes) in repr(one.policy)
    path = one.simulate(0.1, seconds=2)
    assert len(path) == 200
    assert path["time"].iloc[1] == 0.01
    # ẋ(t + dt) = ẋ + ẍ dt (eq. 25) with the run's own actions and time step.
    expected = (
        path["cart_velocity"].iloc[:-1].to_numpy() + 0.01 * path["acceleration"].to_numpy()[:-1]
    )
    np.testing.assert_allclose(path["cart_velocity"].iloc[1:], expected, atol=1e-5)
    by_keys = upswing.train(
        {"name": "full-control", "kind": "full-control", "steps": 600, "pendulum": OWN},
        "table",
        0.5,
    )
    assert by_keys.spec == one.spec
    assert by_keys.measures["digest"] == one.measures["digest"]
    assert one.replay().id == one.id


def test_a_study_trains_another_pendulum_too(study):
    one = study.train("balancing", "table", 0.1, 1, steps=300, pendulum={"gravity": 3.7})
    assert one.spec.task.pendulum.gravity == 3.7
    assert (
        one.measures["digest"]
        != study.train("balancing", "table", 0.1, 1, steps=300).measures["digest"]
    )


def test_every_architecture_of_the_thesis_can_be_trained():
    for name, keys in upswing.api.thesis.ARCHITECTURES.items():
        alpha = None if keys["learner"] == "control" else 0.5
        one = upswing.train("full-control", name, alpha, steps=200)
        assert one.id == f"full-control/{name}/alpha-{'none' if alpha is None else '0.5'}/seed-0"
