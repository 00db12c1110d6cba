"""The viewer beside the report: recordings open from plain files, and nothing else is loaded."""

import os
import re
import subprocess
from pathlib import Path

import pytest

from tests.unit.recordings.pages import LONG, opened, shows_something, unpacked
from upswing.recordings.content_policy import source_of
from upswing.recordings.program import RERUN
from upswing.recordings.singly import chosen_runs, script_of_layout, script_of_run
from upswing.recordings.viewer import write_viewer
from upswing.study import jobs
from upswing.study.claims import load_claims
from upswing.study.ids import recording_id
from upswing.study.paths import VIEWER, comparison

CLAIMS = load_claims(Path("config/claims.yaml"))
RUN = "full-control/modular-networks-5/alpha-1/seed-0"


def test_a_recording_handed_out_is_the_runs_own_file_and_names_its_layout(results, tmp_path):
    script = script_of_run(results, RUN)
    name, content, layout = unpacked(script)
    assert (name, layout) == (recording_id(RUN), "full-control")
    assert content == (results.folder / "runs" / f"{RUN}.rrd").read_bytes()
    assert script_of_run(results, RUN) == script
    _, layout, _ = unpacked(script_of_layout(results, "full-control"))
    assert b"Which stretch of the run" in layout
    file = tmp_path / "layout.rbl"
    file.write_bytes(layout)
    done = subprocess.run([RERUN, "rrd", "verify", file], capture_output=True, check=False)
    assert done.returncode == 0


def test_a_run_without_a_recording_is_named(results):
    missing = "balancing/table/alpha-1/seed-77"
    with pytest.raises(FileNotFoundError, match=r"seed-77\.rrd: missing"):
        script_of_run(results, missing)


def test_chosen_recordings_stand_beside_the_report(results, names):
    folder = results.folder / VIEWER
    assert {"task-balancing", "task-full-control", "claim-C1", "claim-C13"} <= set(names)
    assert {recording_id(run) for run in chosen_runs(results, CLAIMS)} <= set(names)
    assert sorted(path.stem for path in (folder / "recordings").iterdir()) == sorted(names)
    assert not list(folder.parent.glob("*.part"))
    written = {path: path.read_bytes() for path in folder.rglob("*.js")}
    write_viewer(results, CLAIMS, Path("report"))
    # Rerun gives a layout other ids each time; all else is the same.
    assert all(
        path.read_bytes() == content
        for path, content in written.items()
        if path.parent.name != "layouts"
    )


def test_a_script_is_made_anew_of_another_recording_and_by_other_code(results, names, monkeypatch):
    folder = results.folder / VIEWER / "recordings"

    def written_anew():
        for path in folder.iterdir():
            os.utime(path, (0, 0))
        write_viewer(results, CLAIMS, Path("report"))
        return {path.stem for path in folder.iterdir() if path.stat().st_mtime > 0}

    assert written_anew() == set()
    source = results.folder / comparison("claim-C1")
    content = source.read_bytes()
    source.write_bytes(content + b"other")
    os.utime(source, (0, 0))  # however old it says it is
    assert written_anew() == {"claim-C1"}
    source.write_bytes(content)
    assert written_anew() == {"claim-C1"}
    monkeypatch.setattr(jobs, "VIEWER", jobs.TABLES)
    assert written_anew() == set(names)


def test_the_viewers_page_allows_what_it_brings_and_nothing_else(results, names):
    page = (results.folder / VIEWER / "index.html").read_text("utf-8")
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', page)[1]
    assert "unsafe-inline" not in page
    assert "THE-" not in page
    assert "http" not in policy
    for element in ("script", "style"):
        (own,) = re.findall(rf"<{element}>(.*?)</{element}>", page, re.DOTALL)
        assert f"{element}-src" in policy
        assert source_of(own) in policy
    assert not re.search(r'\s(style|on\w+)="', page)


@pytest.mark.parametrize("kind", ["claim", "run"])
def test_a_recording_opens_from_plain_files_and_nothing_leaves_the_page(
    browser, results, names, tmp_path, kind
):
    name = "claim-C13" if kind == "claim" else recording_id(chosen_runs(results, CLAIMS)[0])
    folder = (results.folder / VIEWER).resolve()
    page, requests = opened(browser, f"{(folder / 'index.html').as_uri()}#{name}")
    page.wait_for_selector("body[data-state=open]", timeout=LONG)
    assert shows_something(page, tmp_path)
    assert {Path(address.partition("#")[0]).name for address in requests} == {
        "index.html", f"{name}.js", "viewer.js", "engine.js",
        *(() if kind == "claim" else ("full-control.js", "balancing.js")),
    } - ({"balancing.js"} if name.startswith("full") else {"full-control.js"})  # fmt: skip
    assert all(address.startswith("file://") for address in requests)
    with page.expect_download() as download:
        page.click("#save")
    assert download.value.suggested_filename == f"{name}.rrd"
    content = Path(download.value.path()).read_bytes()
    assert content == unpacked((folder / "recordings" / f"{name}.js").read_text("ascii"))[1]
    page.close()


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("no-such-run", "make browse"),
        ("", "No recording is named"),
        ("<img src=x onerror=alert(1)>", "No recording is named"),
        ("../../index", "No recording is named"),
    ],
)
def test_what_cannot_be_opened_is_explained(browser, results, names, name, expected):
    page, _ = opened(browser, f"{(results.folder / VIEWER / 'index.html').as_uri()}#{name}")
    page.get_by_text(expected).wait_for(timeout=10_000)
    assert page.locator("img").count() == 0
    page.close()


def test_the_page_from_a_file_loads_nothing_from_a_port(browser, results, names):
    """Whoever holds a port of this machine is not asked for scripts."""
    asked = []
    page = browser.new_page()
    page.on("request", lambda request: asked.append(request.url))
    page.goto(f"{(results.folder / VIEWER / 'index.html').as_uri()}#no-such-run")
    page.get_by_text("make browse").wait_for(timeout=10_000)
    assert all(address.startswith("file://") for address in asked)
    page.close()
    for path in (*Path("report").rglob("*.html"), *Path("report").glob("*.js")):
        assert not re.search(r"https?://|localhost|127\.0", path.read_text("utf-8")), path
