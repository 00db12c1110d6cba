"""Recordings: what is in them, which are chosen, and how they are served and shown."""

import subprocess
import sys

import numpy as np
import pytest

from tests.helpers import columns_of_recording, make_spec, run
from upswing.agents.features import locate
from upswing.physics.braking import Stoppable
from upswing.physics.environment import empty_trajectory
from upswing.recordings.program import RERUN
from upswing.runs.metrics import in_windows, measure
from upswing.runs.recording.frames import BEFORE_SUCCESS, STRETCH, stretches
from upswing.runs.simulation import prepare
from upswing.runs.snapshots import look, moments, snapshots
from upswing.runs.train import train

# One small study serves all tests of this file: on one worker.


# What is recorded.


@pytest.mark.parametrize("kind", ["balancing", "full-control"])
def test_stretches_are_whole_and_end_in_a_gap(kind):
    trajectory, _ = run(make_spec(kind, "table", 0.5, 30_000))
    stable = measure(trajectory, kind == "balancing", Stoppable(15.0, 15.0)).first_stable_step
    frames = stretches(trajectory, in_windows(trajectory, Stoppable(20.0, 20.0)), stable, 0.005)
    assert (np.diff(frames.steps) > 0).all()
    whole = frames.steps[~frames.gap]
    assert set(range(STRETCH)) | set(range(30_000 - STRETCH, 30_000)) <= set(whole.tolist())
    # A line goes on only from a step to the next one: before every leap stands a gap.
    leaps = np.flatnonzero(np.diff(frames.steps) > 1)
    assert frames.gap[leaps].all()
    assert frames.gap.sum() == len(leaps) + 1


@pytest.mark.parametrize("kind", ["balancing", "full-control"])
def test_stretches_are_named_and_none_overlaps_another(kind):
    trajectory, _ = run(make_spec(kind, "table", 0.5, 30_000))
    stable = measure(trajectory, kind == "balancing", Stoppable(15.0, 15.0)).first_stable_step
    frames = stretches(trajectory, in_windows(trajectory, Stoppable(20.0, 20.0)), stable, 0.005)
    covered = [step for one in frames.named for step in range(one.first, one.after)]
    assert covered == frames.steps[~frames.gap].tolist()
    names = " and ".join(one.name for one in frames.named)
    expected = {"beginning", "worst", "end"} | ({"first stable"} if stable is not None else set())
    assert set(names.split(" and ")) == expected
    if stable is not None:
        (one,) = (one for one in frames.named if "first stable" in one.name)
        assert one.first == max(0, stable - STRETCH // BEFORE_SUCCESS)


def test_snapshots_are_what_was_known_then():
    spec = make_spec("full-control", "modular-table", 0.5, 4_000)
    setting = prepare(spec, 0)
    looked = [(0, look(setting.learner, setting.encoder))]
    trajectory = empty_trajectory(4_000)
    setting.advance(trajectory, 0, 4_000)
    looked.append((4_000, look(setting.learner, setting.encoder)))
    seen = snapshots(setting.encoder, looked)
    assert seen.q.shape == (2, 8, 20, 3)
    assert (seen.q[0] == 0).all()
    for angle, velocity in [(0.1, 0.1), (3.0, -7.0), (-2.0, 19.0), (-0.5, 0.5)]:
        module, (tile,) = locate(setting.encoder, angle, velocity)
        row, column = int((angle + np.pi) // (np.pi / 4)), int((velocity + 20) // 2)
        np.testing.assert_array_equal(
            seen.q[1, row, column], setting.learner.learned["q"][module, tile]
        )
        assert seen.owner[row, column] == module


@pytest.mark.parametrize("steps", [1, 50, 6_000, 1_000_000])
def test_moments_go_from_the_beginning_to_the_end(steps):
    found = moments(steps)
    assert found[0] == 0
    assert found[-1] == steps
    assert len(found) <= 40
    assert (np.diff(found) > 0).all()


def test_identical_runs_have_equal_recordings(results, tmp_path):
    spec = results.cells["balancing/table/alpha-1"].of_seed(1)
    train(spec, tmp_path)
    train(spec, tmp_path / "again")
    one, again = (
        folder / "runs" / f"{spec.run(1)}.rrd" for folder in (tmp_path, tmp_path / "again")
    )
    # How long a run took stands in its properties and words, and differs.
    ours = {
        chunk: rows for chunk, rows in columns_of_recording(one).items() if "about" not in chunk
    }
    assert ours == {
        chunk: rows for chunk, rows in columns_of_recording(again).items() if "about" not in chunk
    }
    assert (
        subprocess.run([RERUN, "rrd", "verify", one], check=False, capture_output=True).returncode
        == 0
    )


FULL = """
import resource, signal, sys
from pathlib import Path
from tests.helpers import columns_of_recording, make_spec
from upswing.runs.train import RunsFailed, train
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), -1))
try:
    train(make_spec(steps=20_000), Path(sys.argv[1]))
except RunsFailed as error:
    print(error)
"""


@pytest.mark.parametrize("before", ["nothing", "an older run"])
def test_a_disk_that_fills_while_a_recording_is_written_is_said_and_leaves_no_half_set(
    tmp_path, before
):
    spec = make_spec(steps=20_000)
    train(spec, tmp_path / "whole")
    place = tmp_path / "whole/runs" / spec.run(0)
    sizes = {path.suffix: path.stat().st_size for path in place.parent.glob("seed-0.*")}
    trajectory = place.with_name("seed-0.trajectory.parquet").stat().st_size
    assert trajectory < 250_000 < sizes[".rrd"], "the limit must hit the recording"
    if before == "an older run":
        train(spec, tmp_path / "full")
    command = [sys.executable, "-c", FULL, tmp_path / "full", "250000"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "File too large" in done.stdout, done
    assert "alpha-1/seed-0" in done.stdout
    assert "Traceback" not in done.stderr
    assert "prematurely" not in done.stdout + done.stderr
    assert [path for path in (tmp_path / "full").rglob("*") if path.is_file()] == []
