"""Watching a run learn: it is the run of the study, it is seen whole, and nothing of it is left behind."""

import signal
import socket
import subprocess
import sys
import threading
import time
from collections import defaultdict
from contextlib import contextmanager

import numpy as np
import psutil
import pytest
from rerun.experimental import ViewerClient

from tests.helpers import beyond_spec, make_spec
from tests.unit.recordings.test_browsing import DRIVERS
from upswing.cli.main import main
from upswing.physics.environment import empty_trajectory
from upswing.recordings import looking as looking_module
from upswing.recordings.live import Live, Plan
from upswing.recordings.looking import page
from upswing.recordings.pace import FAST, REAL, Pace, parse_speed
from upswing.recordings.ports import free_port
from upswing.recordings.program import RERUN
from upswing.recordings.screenshots import headless_viewer, wait_until_loaded
from upswing.recordings.watch import Closed, watch, watch_in
from upswing.runs.recording.frames import STRETCH
from upswing.runs.simulation import prepare
from upswing.runs.snapshots import look, snapshots
from upswing.study.errors import BadInput

STEPS = 3_000
RUNS = [
    "balancing/table/alpha-0.1/seed-1",
    "full-control/modular-networks-5/alpha-1/seed-2",
    "balancing/idle/alpha-none/seed-0",
]


def rows(path):
    """The rows of a recording, by entity, column, step and frame; none stands there twice."""
    import rerun as rr

    reader = rr.chunk.RrdReader(path)
    (store,) = reader.recordings()
    found = defaultdict(dict)
    for chunk in reader.stream(store=store):
        entity, batch = str(chunk.entity_path), chunk.to_record_batch()
        if entity.startswith("/__properties") or "step" not in batch.schema.names:
            continue
        columns = batch.to_pydict()
        for name in batch.schema.names:
            if "rowid" in name.lower() or "log_t" in name or name in ("step", "frame"):
                continue
            for step, frame, value in zip(
                columns["step"], columns.get("frame", columns["step"]), columns[name], strict=True
            ):
                # What is known is drawn again at the end, all of it in one scale, and told anew.
                again = entity.startswith(("/learned", "/about"))
                assert again or (step, frame) not in found[entity, name]
                found[entity, name][step, frame] = repr(value)
    return found


def drawn(path, size, shown, spec):
    """The rows of a run that is drawn in pieces of so many steps."""
    setting, trajectory = prepare(spec, 0), empty_trajectory(STEPS)
    live = Live(spec, setting.body, Plan.of(shown, "shown", setting.body.time_step), trajectory)
    live.remember()
    known = snapshots(setting.encoder, [(0, look(setting.learner, setting.encoder))])
    for first in range(0, STEPS, size):
        last = min(first + size, STEPS)
        setting.advance(trajectory, first, last)
        live.draw(first, last, known)
    live.write(path)
    live.end()
    return rows(path)


OWN = beyond_spec(
    steps=STEPS,
    task={
        "pendulum": {"length": 0.4, "time_step": 0.01, "accelerations": (-20, -10, 0, 10, 20)},
        "track": {"limit": 0.5},
    },
)


@pytest.mark.parametrize(
    ("spec", "share"),
    [
        *((make_spec("balancing", "table", 0.1, STEPS), share) for share in (1.0, 0.3, 0.7)),
        (OWN, 0.7),
    ],
)
def test_what_is_drawn_in_pieces_is_what_is_drawn_at_once(tmp_path, spec, share):
    shown = np.arange(STEPS) % 100 >= 100 * (1 - share)
    whole = drawn(tmp_path / "whole.rrd", STEPS, shown, spec)
    assert {entity for entity, _ in whole} >= {"/angle", "/pendulum/rod", "/phase/trail", "/events"}
    for size in (8, 37, 1_000):
        pieces = drawn(tmp_path / f"{size}.rrd", size, shown, spec)
        assert pieces == whole, size


@pytest.mark.parametrize("run", RUNS)
@pytest.mark.parametrize("speed", ["fast", "real", "30"])
def test_the_watched_run_is_the_stored_run_bit_for_bit(results, tmp_path, capsys, run, speed):
    path = tmp_path / "watched.rrd"
    asked = ["watch", run, "--speed", speed, "--save", str(path), "--results", str(results.folder)]
    assert main(asked) == 0
    stored = results.runs.set_index("run").loc[run]
    digest = f"Digest {stored['digest']}: that of the run stored in {results.folder}."
    assert digest in capsys.readouterr().out
    found = rows(path)
    steps = {step for step, _ in found["/angle", "Scalars:scalars"]}
    assert max(steps) == 7_000  # the row that ends the line
    if speed == "real":
        assert len(steps) == 7_001


def test_another_length_is_another_run(results, tmp_path, capsys):
    asked = ["watch", RUNS[0], "--steps", "900", "--speed", "fast"]
    asked += ["--results", str(results.folder)]
    assert main([*asked, "--save", str(tmp_path / "watched.rrd")]) == 0
    assert "no run of this specification is stored" in capsys.readouterr().out


def test_what_is_shown_of_a_run_depends_on_the_speed():
    steps = 100_000
    task = make_spec(steps=steps).task
    for speed in (REAL, 10.0):
        assert np.array_equal(Pace.of(speed, task).plan(steps).frames.steps[:-1], np.arange(steps))
    fast = Pace.of(FAST, task)
    shown = fast.plan(steps).frames
    assert fast.size == 1_000
    assert (~shown.gap).sum() == 100 * STRETCH
    assert list(fast.pieces(steps))[-1] == (99_000, 100_000)
    assert set(range(99_550, 100_000)) <= set(shown.steps.tolist())


def test_a_longer_time_step_takes_its_time():
    pace = Pace.of(REAL, OWN.task)
    assert pace.size == 4  # 40 ms
    assert pace.due(1_000) == 10.0
    whole = Pace.of(FAST, OWN.task)
    assert whole.size == STRETCH // 2  # 2.25 s
    assert pace.plan(STEPS).frames.time_step == 0.01


def test_it_learns_in_real_time():
    spec, begun = make_spec(steps=200), time.monotonic()
    watch(spec, Pace.of(REAL, spec.task), Live.remember)
    assert time.monotonic() - begun >= 0.96
    begun = time.monotonic()
    assert watch(spec, Pace.of(REAL, spec.task, waits=False), Live.remember).measures.steps == 200


@pytest.mark.skipif(not DRIVERS, reason="no Vulkan driver: install mesa-vulkan-drivers")
@pytest.mark.parametrize(("run", "speed"), [(RUNS[0], FAST), (RUNS[1], 20.0)])
def test_a_headless_viewer_follows_a_run_without_a_problem(
    results, tmp_path, monkeypatch, run, speed
):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    cell, _, seed = run.rpartition("/seed-")
    spec = results.cells[cell].of_seed(int(seed))
    with headless_viewer() as viewer:
        watch(
            spec,
            Pace.of(speed, spec.task),
            lambda live: live.stream.connect_grpc(viewer.url),
        )
        wait_until_loaded(viewer)
        time.sleep(1)
        state = viewer.get_state()
        assert [view.reports for view in state.views if view.reports] == []
        assert {"2D", "TimeSeries", "TextDocument", "TextLog"} <= {
            view.view_class for view in state.views
        }
        (recording,) = state.recordings
        assert recording.current_timeline == "frame"
        ends = {timeline.name: timeline.end for timeline in recording.timelines}
        assert ends["step"] == 7_000
        assert recording.current_time >= ends["frame"] - 1  # it follows what comes
        assert len(viewer.take_screenshot()) > 20_000


@pytest.mark.skipif(not DRIVERS, reason="no Vulkan driver: install mesa-vulkan-drivers")
def test_a_window_of_its_own_is_opened_and_closed(tmp_path, monkeypatch):
    """The viewer is started as for a window, but draws without a screen."""
    viewer = tmp_path / "viewer"
    viewer.write_text(f'#!/bin/sh\nexec "{RERUN}" --headless "$@"\n')
    viewer.chmod(0o700)
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setattr(looking_module, "RERUN", viewer)
    monkeypatch.setenv("DISPLAY", ":0")  # which it does not use
    spec = make_spec(steps=500)
    with looking_module.window() as looking:
        watch(spec, Pace.of(FAST, spec.task), lambda live: live.stream.connect_grpc(looking.url))
        client = ViewerClient.connect(looking.url)
        wait_until_loaded(client)
        (recording,) = client.get_state().recordings
        assert recording.store_id.endswith("balancing_table_alpha-1_seed-0-live")
        assert looking.looks
    assert not looking.looks


@contextmanager
def watching(results, *words):
    """A process that shows a run on a page, its children, and the address of the page."""
    web, port = free_port(), free_port()
    command = [
        sys.executable, "-m", "upswing.cli", "watch", *words, "--web", "--port", str(port),
        "--web-port", str(web), "--results", str(results.folder),
    ]  # fmt: skip
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        said = process.stdout.readline().decode()
        assert " at http://127.0.0.1:" in said, said
        yield process, psutil.Process(process.pid).children(recursive=True), said.split()[-1]
    finally:
        process.kill()
        process.wait(20)


@pytest.mark.parametrize(
    ("sign", "code"),
    [(signal.SIGINT, 0), (signal.SIGTERM, 0), (signal.SIGHUP, 129), (signal.SIGKILL, -9)],
)
@pytest.mark.parametrize("speed", ["real", "fast"])  # in the middle of it, and after its end
def test_however_it_ends_it_leaves_nothing_behind(results, sign, code, speed):
    before = sorted(results.folder.rglob("*"))
    with watching(results, RUNS[0], "--speed", speed) as (process, children, _):
        assert children
        if speed == "fast":
            for line in process.stdout:
                if b"It stays to be looked at" in line:
                    break
        else:
            time.sleep(1)
        process.send_signal(sign)
        assert process.wait(60) == code
    _, alive = psutil.wait_procs(children, timeout=5)
    assert not alive
    assert sorted(results.folder.rglob("*")) == before


def test_who_closes_the_viewer_ends_it(results, capsys):
    @contextmanager
    def closed_soon():
        with page(free_port(), free_port()) as looking:
            threading.Timer(1.5, looking.process.terminate).start()
            yield looking

    begun = time.monotonic()
    watch_in(closed_soon(), make_spec(steps=50_000), REAL, results.folder)
    assert "closed before the run ended. Nothing is stored." in capsys.readouterr().out
    assert time.monotonic() - begun < 60
    with pytest.raises(Closed):
        watch(make_spec(), Pace.of(REAL, make_spec().task), Live.remember, lambda: False)


def test_without_a_display_nothing_is_learned(results, monkeypatch, capsys):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    assert main(["watch", RUNS[0], "--results", str(results.folder)]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.splitlines()[1:] == ["  there is no display here; --web serves a page instead"]


def test_a_port_in_use_is_named(results, capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        asked = ["watch", RUNS[0], "--web", "--port", str(port), "--results", str(results.folder)]
        assert main(asked) == 2
    assert f"port {port} is in use" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "speed"), [("real", 1.0), ("fast", np.inf), ("10", 10.0), ("0.5", 0.5)]
)
def test_speeds(text, speed):
    assert parse_speed(text) == speed


@pytest.mark.parametrize("text", ["0", "-1", "inf", "nan", "quick", ""])
def test_a_speed_that_is_none_is_explained(text):
    with pytest.raises(BadInput, match="must be real, fast, or a number of times real time"):
        parse_speed(text)
