"""What a run leaves on disk, read back."""

import json

import numpy as np
import pyarrow.parquet as pq
import pytest
import rerun as rr
from safetensors.numpy import load_file

from tests.helpers import make_spec, run
from upswing.physics.braking import Stoppable
from upswing.runs.files.atomic import written
from upswing.runs.files.trajectory import WHOLE_AT_START, kept_steps, read_metadata
from upswing.runs.metrics import measure
from upswing.runs.train import RunsFailed, train
from upswing.study.spec import parse

COLUMNS = [
    "step", "angle", "angular_velocity", "cart_position", "cart_velocity", "action", "reward",
    "td_error", "reset",
]  # fmt: skip


@pytest.fixture(scope="module")
def stored(tmp_path_factory):
    """A folder with two runs, and their specification."""
    spec = make_spec("balancing", "networks-5", 0.5, steps=30_000, seeds=(0, 4))
    results = tmp_path_factory.mktemp("results")
    train(spec, results)
    return results / "runs" / spec.cell, spec


def test_every_run_has_its_files_and_nothing_else_is_there(stored):
    folder, _ = stored
    endings = ("rrd", "trajectory.parquet", "weights.safetensors", "windows.parquet")
    assert sorted(path.name for path in folder.iterdir()) == [
        f"seed-{seed}.{ending}" for seed in (0, 4) for ending in endings
    ]


def test_the_stored_trajectory_is_the_trajectory(stored):
    folder, spec = stored
    table = pq.read_table(folder / "seed-4.trajectory.parquet")
    assert table.column_names == COLUMNS
    trajectory, _ = run(spec, 4)
    steps = table["step"].to_numpy()
    for name in COLUMNS[1:]:
        np.testing.assert_array_equal(table[name].to_numpy(), getattr(trajectory, name)[steps])
    assert table.schema.field("angle").metadata == {b"unit": b"rad"}


def test_what_is_looked_at_closely_is_kept_whole():
    trajectory, _ = run(make_spec("balancing", "table", 0.5, steps=50_000))
    stable = measure(trajectory, True, Stoppable(15.0, 15.0)).first_stable_step
    kept = set(kept_steps(trajectory, stable).tolist())
    assert set(range(WHOLE_AT_START)) <= kept
    assert set(range(49_000, 50_000)) <= kept
    assert set(np.flatnonzero(trajectory.reset).tolist()) <= kept
    assert set(range(stable, stable + 1_000)) <= kept
    assert len(kept) < 20_000


def test_a_million_steps_are_thinned_to_a_few_thousand():
    trajectory, _ = run(make_spec("full-control", "table", 0.5, steps=1_000_000))
    kept = kept_steps(trajectory, None)
    assert 11_000 < len(kept) < 20_000
    assert np.diff(kept).max() == 250


def test_metadata_tells_where_a_file_is_from(stored):
    folder, spec = stored
    for kind in ("trajectory", "windows"):
        found = read_metadata(folder / f"seed-4.{kind}.parquet")
        assert parse(found["spec"]) == parse(spec.of_seed(4).canonical())
        assert set(found["provenance"]) >= {"git_commit", "dirty", "packages", "machine", "python"}
    assert found["outcome"]["steps"] == 30_000
    assert found["outcome"]["seconds"] > 0


def test_the_weights_are_what_was_learned(stored):
    folder, spec = stored
    _, learned = run(spec, 4)
    weights = load_file(folder / "seed-4.weights.safetensors")
    assert weights.keys() == learned.keys()
    for name in weights:
        np.testing.assert_array_equal(weights[name], learned[name])


def test_the_recording_read_back(stored):
    folder, _ = stored
    reader = rr.chunk.RrdReader(folder / "seed-4.rrd")
    (store,) = reader.recordings()
    assert store.application_id == "upswing-balancing"
    assert store.recording_id == "balancing_networks-5_alpha-0-5_seed-4"
    rows, names, properties = {}, set(), {}
    for chunk in reader.stream(store=store):
        batch = chunk.to_record_batch()
        entity = str(chunk.entity_path)
        names |= set(batch.schema.names)
        if entity.startswith("/__properties"):
            for name in batch.schema.names:
                properties[name.split(":")[-1]] = batch[name].to_pylist()
        elif "step" in batch.schema.names:
            rows[entity] = rows.get(entity, 0) + batch.num_rows
    assert {"frame", "step", "sim_time"} <= names
    lines = {
        "/angle",
        "/angular_velocity",
        "/cart/position",
        "/cart/velocity",
        "/action",
        "/learning",
    }
    pictures = {
        "/pendulum/rod",
        "/pendulum/push",
        "/pendulum/ground",
        "/phase/state",
        "/phase/trail",
    }
    maps = {"/learned/policy", "/learned/value"}
    assert set(rows) == lines | pictures | maps | {"/events", "/envelope/angle", "/stretch"}
    for together in (lines, pictures, maps):
        assert len({rows[entity] for entity in together}) == 1
    assert 30 <= rows["/learned/policy"] <= 40
    assert (folder / "seed-4.rrd").stat().st_size < 600_000
    assert properties["alpha"] == [[0.5]]
    assert properties["seed"] == [[4]]
    assert properties["falls"][0][0] > 0
    assert json.loads(properties["spec"][0][0])["seeds"] == [4]


def test_the_same_spec_gives_identical_tables(stored, tmp_path):
    folder, spec = stored
    train(spec.of_seed(4), tmp_path)
    for kind in ("trajectory", "windows"):
        name = f"seed-4.{kind}.parquet"
        again = pq.read_table(tmp_path / "runs" / spec.cell / name)
        # NaN is not equal to NaN for Arrow; a frame's equality takes them as equal.
        assert pq.read_table(folder / name).to_pandas().equals(again.to_pandas())


def test_a_failing_run_is_named_and_the_others_are_there(tmp_path, monkeypatch, capsys):
    from upswing.runs import train as module

    spec = make_spec("balancing", "table", steps=1_000, seeds=(0, 1, 2))
    learn = module.learn

    def failing(one, seed, trajectory):
        if seed == 1:
            raise FloatingPointError("injected")
        return learn(one, seed, trajectory)

    monkeypatch.setattr(module, "learn", failing)
    with pytest.raises(RunsFailed, match=r"balancing/table/alpha-1/seed-1: FloatingPointError"):
        train(spec, tmp_path)
    left = {path.name.split(".")[0] for path in (tmp_path / "runs" / spec.cell).iterdir()}
    assert left == {"seed-0", "seed-2"}


def test_a_file_is_whole_or_not_there(tmp_path):
    path = tmp_path / "deep" / "file"

    def fail_half_way():
        with written(path) as beside:
            beside.write_text("half", "utf-8")
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fail_half_way()
    assert list(path.parent.iterdir()) == []
    with written(path) as beside:
        beside.write_text("whole", "utf-8")
    assert [p.name for p in path.parent.iterdir()] == ["file"]
