"""Browsing: comparisons, filters, the catalog and a viewer without a screen."""

import shutil
import signal
import socket
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

import psutil
import pytest
from PIL import Image

from tests.helpers import columns_of_recording
from upswing.cli.main import main
from upswing.recordings import catalog as catalog_module
from upswing.recordings.catalog import catalog
from upswing.recordings.comparison import write_comparison, write_comparisons
from upswing.recordings.comparison_names import comparison_names
from upswing.recordings.ports import free_port
from upswing.recordings.program import RERUN
from upswing.recordings.run_filter import select
from upswing.recordings.screenshots import headless_viewer, take_screenshots, wait_until_loaded
from upswing.runs.recording.layout import run_layout
from upswing.study.claims import load_claims
from upswing.study.errors import BadInput
from upswing.study.task import task_named


def test_comparisons_hold_every_run_of_a_task_and_three_of_a_claim(results):
    claims = load_claims(Path("config/claims.yaml"))
    paths = {path.stem: path for path in write_comparisons(results, claims)}
    assert sorted(paths) == sorted(comparison_names(claims, results.cells))
    assert {"task-balancing", "task-full-control", "claim-C1", "claim-C13"} <= set(paths)
    task = columns_of_recording(paths["task-balancing"])
    for cell in ("table/alpha-1", "table/alpha-0.1", "idle/alpha-none"):
        place = f"/cells/{cell}".replace(".", r"\.")
        names = [name for name in task if name.startswith((f"/cells/{cell}/runs", f"{place}/runs"))]
        assert names, (cell, sorted(task))
    claim = columns_of_recording(paths["claim-C13"])
    assert {name.split("/")[1] for name in claim if "pendulum/rod" in name} == {
        "worst",
        "median",
        "best",
    }


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ([], 12),
        (["task=balancing"], 9),
        (["task=balancing", "alpha=0.1"], 3),
        (["alpha=none"], 3),
        (["architecture=table,idle", "seed=0..1"], 6),
        (["seed=2"], 4),
        (["balancing/table/alpha-0.1/seed-2"], 1),
        (["results/runs/balancing/table/alpha-0.1/seed-2.rrd"], 1),
        (["balancing/table"], 6),
        (["claim=C1"], 3),
    ],
)
def test_a_filter_chooses_runs(results, words, expected):
    assert len(select(results, words)) == expected


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["task=balancin"], "did you mean 'balancing'"),
        (["alpha=0.2"], "filter: alpha=0.2: no such run"),
        (["seed=7"], "seed=7: no such run; there are 0, 1, 2"),
        (["speed=7"], "unknown key; did you mean 'seed'"),
        (["balancing/tabel"], "no such run; did you mean 'balancing/table/"),
        (["claim=C17"], "no such claim; did you mean 'C"),
        (["claim=C16"], "not about recorded runs"),
        (["task=full-control", "alpha=0.1"], "no such run"),
    ],
)
def test_a_filter_that_fits_nothing_is_explained(results, words, expected):
    with pytest.raises(BadInput) as caught:
        select(results, words)
    assert expected in str(caught.value)


def test_print_only_says_what_it_would_open(results, capsys):
    assert main(["browse", "alpha=0.1", "seed=1", "--print", "--results", str(results.folder)]) == 0
    assert capsys.readouterr().out.strip().endswith("runs/balancing/table/alpha-0.1/seed-1.rrd")


def test_without_results_it_says_how_to_make_them(tmp_path, capsys):
    assert main(["browse", "--results", str(tmp_path)]) == 2
    assert "`make reproduce` makes" in capsys.readouterr().err


def test_the_catalog_lists_every_run_with_its_properties_on_loopback_alone(results):
    port = free_port()
    with catalog(results, results.runs, port) as served:
        assert served.url == f"rerun+http://127.0.0.1:{port}"
        listening = [
            c
            for c in psutil.Process().net_connections()
            if c.laddr.port == port and c.status == "LISTEN"
        ]
        assert {c.laddr.ip for c in listening} == {"127.0.0.1"}
        from rerun.catalog import CatalogClient

        dataset = CatalogClient(served.url).get_dataset("balancing")
        table = dataset.segment_table().to_pandas()
        assert len(table) == 9
        assert {f"property:run:{name}" for name in ("alpha", "seed", "falls")} <= set(table.columns)
        assert len(dataset.blueprints()) == 2  # of a run, and of the table


def test_a_port_in_use_is_named(results):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with (
            pytest.raises(BadInput, match=f"port {port} is in use"),
            catalog(results, results.runs, port),
        ):
            pass


def test_without_a_display_it_says_what_to_do_before_anything_is_registered(
    results, monkeypatch, capsys
):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setattr(catalog_module, "catalog_of", lambda *_: pytest.fail("registered"))
    port = free_port()
    assert main(["browse", "--port", str(port), "--results", str(results.folder)]) == 2
    said = capsys.readouterr().err
    assert "browse --web" in said
    assert "make browse WEB=1" in said
    assert f"ssh -N -L {port}:127.0.0.1:{port} -L 9872:127.0.0.1:9872 -L 9873:" in said


def browsing(results, *words):
    """A process that serves a page of the runs, and its children; other ports if these were taken."""
    for _ in range(3):
        web, port, report = free_port(), free_port(), free_port()
        command = [
            sys.executable, "-m", "upswing.cli", "browse", *words, "--web", "--port", str(port),
            "--web-port", str(web), "--report-port", str(report), "--results", str(results.folder),
        ]  # fmt: skip
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        until = time.monotonic() + 60
        while process.poll() is None and time.monotonic() < until:
            children = psutil.Process(process.pid).children(recursive=True)
            with socket.socket() as probe:
                if children and probe.connect_ex(("127.0.0.1", web)) == 0:
                    return process, children
            time.sleep(0.1)
        process.kill()
        said = process.stdout.read()
        if b"is in use" not in said:
            break
    pytest.fail(f"no page was served: {said!r}")


@pytest.mark.parametrize(
    ("sign", "code"),
    [(signal.SIGINT, 0), (signal.SIGTERM, 0), (signal.SIGHUP, 129), (signal.SIGKILL, -9)],
)
def test_however_browse_ends_it_leaves_no_process_behind(results, sign, code):
    process, children = browsing(results)
    try:
        process.send_signal(sign)
        assert process.wait(15) == code
    finally:
        process.kill()
    _, alive = psutil.wait_procs(children, timeout=5)
    assert not alive


DRIVERS = list(Path("/usr/share/vulkan/icd.d").glob("*.json"))


@pytest.mark.skipif(not DRIVERS, reason="no Vulkan driver: install mesa-vulkan-drivers")
@pytest.mark.parametrize("kind", ["balancing", "full-control"])
def test_a_headless_viewer_shows_every_view_of_a_run_without_a_problem(
    results, tmp_path, monkeypatch, kind
):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    recording = next((results.folder / "runs" / kind).rglob("*.rrd"))
    layout = tmp_path / "layout.rbl"
    run_layout(task_named(kind, kind=kind, steps=1)).save(f"upswing-{kind}", layout)
    with headless_viewer() as viewer:
        viewer.open(str(layout), navigate=False)
        viewer.open(str(recording))
        wait_until_loaded(viewer)
        viewer.set_time("frame", sequence=200, play_state="paused")
        time.sleep(0.5)
        views = viewer.get_state().views
        assert len(views) == 12
        assert {view.view_class for view in views} == {
            "2D",
            "StateTimeline",
            "TimeSeries",
            "TextDocument",
            "TextLog",
        }
        assert [view.reports for view in views if view.reports] == []
        assert len(viewer.take_screenshot()) > 20_000


@pytest.mark.skipif(not DRIVERS, reason="no Vulkan driver: install mesa-vulkan-drivers")
@pytest.mark.parametrize(("name", "classes"), [
    ("claim-C13", {"2D": 3, "TimeSeries": 3, "TextDocument": 1, "StateTimeline": 1}),
    ("task-balancing", {"TimeSeries": 4, "TextDocument": 1}),
])  # fmt: skip
def test_a_headless_viewer_shows_every_view_of_a_comparison_without_a_problem(
    results, tmp_path, monkeypatch, name, classes
):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    path = write_comparison(results, load_claims(Path("config/claims.yaml")), name)
    with headless_viewer() as viewer:
        viewer.open(str(path))
        wait_until_loaded(viewer)
        time.sleep(0.5)
        views = viewer.get_state().views
        assert Counter(view.view_class for view in views) == classes
        assert [view.reports for view in views if view.reports] == []


@pytest.mark.skipif(not DRIVERS, reason="no Vulkan driver: install mesa-vulkan-drivers")
def test_screenshots_are_taken(results, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    write_comparisons(results, load_claims(Path("config/claims.yaml")))
    take_screenshots(
        results, tmp_path, "full-control/modular-networks-5/alpha-1/seed-0", "full-control"
    )
    for name in ("run", "comparison", "catalog"):
        with Image.open(tmp_path / f"{name}.png") as picture:
            assert picture.width == 1440
            assert len(picture.convert("RGB").getcolors(1 << 20)) > 20  # something is drawn


def test_rerun_is_installed_beside_python():
    assert shutil.which(str(RERUN))
