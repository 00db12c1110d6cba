"""Recordings in a browser: from plain files, from the desk of `upswing browse`, from the catalog."""

import base64
import gzip
import re
import socket
import subprocess
import urllib.error
import urllib.request
from pathlib import Path

import pytest
from PIL import Image

from tests.test_recordings import browsing
from upswing.recordings import lending as lending_module
from upswing.recordings.comparison import write_comparisons
from upswing.recordings.lending import PORT, lending
from upswing.recordings.names import VIEWER, recording_id
from upswing.recordings.singly import chosen_runs, script_of_run, with_layout
from upswing.recordings.viewer import FOLDER, write_viewer

pytestmark = pytest.mark.xdist_group("viewer")
RUN = "full-control/modular-networks-5/alpha-1/seed-0"
LONG = 90_000
"""A browser that draws in software has so long to show a recording [ms]."""


@pytest.fixture(scope="module")
def names(results):
    """The names of the recordings beside the report, which are written."""
    write_comparisons(results)
    return write_viewer(results, Path("report"))


def unpacked(script):
    name, packed = re.fullmatch(r'arrived\("([\w-]+)","([\w+/=]+)"\)\n', script).groups()
    return name, gzip.decompress(base64.b64decode(packed))


def test_a_recording_handed_out_is_whole_and_has_its_layout(results, tmp_path):
    name, content = unpacked(script_of_run(results, RUN))
    assert name == recording_id(RUN)
    file = tmp_path / "one.rrd"
    file.write_bytes(content)
    done = subprocess.run([VIEWER, "rrd", "verify", file], capture_output=True, check=False)
    assert done.returncode == 0
    alone = (results.folder / "runs" / f"{RUN}.rrd").read_bytes()
    assert b"Phase plane, policy" in content
    assert b"Phase plane, policy" not in alone


def test_a_run_without_a_recording_is_named(results):
    with pytest.raises(FileNotFoundError, match=r"seed-77\.rrd: missing"):
        with_layout(results, "balancing/table/alpha-1/seed-77")


def test_chosen_recordings_stand_beside_the_report(results, names):
    folder = results.folder / FOLDER
    assert {"task-balancing", "task-full-control", "claim-C1", "claim-C13"} <= set(names)
    assert {recording_id(run) for run in chosen_runs(results)} <= set(names)
    assert sorted(path.stem for path in (folder / "recordings").iterdir()) == sorted(names)
    assert not list(folder.parent.glob("*.part"))
    written = {path: path.read_bytes() for path in folder.rglob("*.js")}
    write_viewer(results, Path("report"))
    engines = {path for path in written if path.name in ("viewer.js", "engine.js")}
    assert all(path.read_bytes() == written[path] for path in engines)


def opened(browser, address):
    page = browser.new_page(viewport={"width": 1280, "height": 720})
    requests = []
    page.on("request", lambda request: requests.append(request.url))
    page.goto(address)
    return page, requests


def shades(page, tmp_path):
    """How many colours the page shows; a blank page shows few."""
    picture = tmp_path / "page.png"
    page.screenshot(path=picture, timeout=LONG)
    with Image.open(picture) as image:
        return len(image.convert("RGB").getcolors(1 << 20))


def shows_something(page, tmp_path):
    for _ in range(30):
        page.wait_for_timeout(500)
        if (count := shades(page, tmp_path)) > 200:
            return count
    return 0


@pytest.mark.parametrize("kind", ["claim", "run"])
def test_a_recording_opens_from_plain_files_and_nothing_leaves_the_page(
    browser, results, names, tmp_path, kind
):
    name = "claim-C13" if kind == "claim" else recording_id(chosen_runs(results)[0])
    folder = (results.folder / FOLDER).resolve()
    page, requests = opened(browser, f"{(folder / 'index.html').as_uri()}#{name}")
    page.wait_for_selector("body[data-state=open]", timeout=LONG)
    assert shows_something(page, tmp_path)
    assert {Path(address.partition("#")[0]).name for address in requests} == {
        "index.html", f"{name}.js", "viewer.js", "engine.js",
    }  # fmt: skip
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
    page, _ = opened(browser, f"{(results.folder / FOLDER / 'index.html').as_uri()}#{name}")
    page.get_by_text(expected).wait_for(timeout=10_000)
    assert page.locator("img").count() == 0
    page.close()


def free(port):
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) != 0


def test_while_browsing_the_page_opens_every_run(browser, results, names, tmp_path):
    if not free(PORT):
        pytest.skip(f"port {PORT} is in use here")
    missing = next(run for run in results.runs["run"] if recording_id(run) not in names)
    address = f"{(results.folder / FOLDER / 'index.html').as_uri()}#{recording_id(missing)}"
    with lending(results) as port:
        assert port == PORT
        page, requests = opened(browser, address)
        page.wait_for_selector("body[data-state=open]", timeout=LONG)
        assert f"http://127.0.0.1:{PORT}/{recording_id(missing)}.js" in requests
        page.close()
    assert free(PORT)


def test_the_page_asks_at_the_port_that_is_served():
    page = Path("report/viewer.html").read_text("utf-8")
    assert set(re.findall(r"127\.0\.0\.1:(\d+)", page)) == {str(PORT)}


def answer(port, path, host=None):
    request = urllib.request.Request(f"http://127.0.0.1:{port}/{path}")
    if host:
        request.add_header("Host", host)
    try:
        with urllib.request.urlopen(request, timeout=10) as reply:
            return reply.status, reply.read().decode("ascii")
    except urllib.error.HTTPError as error:
        return error.code, ""


def test_the_desk_hands_out_runs_and_nothing_else(results, monkeypatch):
    with lending(results, 0) as port:
        status, script = answer(port, f"{recording_id(RUN)}.js")
        assert status == 200
        assert unpacked(script)[0] == recording_id(RUN)
        for path in ("", "study.json", "../study.json", "%2e%2e/study.json", "runs/x.js"):
            assert answer(port, path)[0] == 404
        assert answer(port, f"{recording_id(RUN)}.js", "elsewhere.example")[0] == 403
        monkeypatch.setattr(
            lending_module, "script_of_run", lambda *_: (_ for _ in ()).throw(OSError("gone"))
        )
        assert answer(port, f"{recording_id(RUN)}.js")[0] == 500
        with lending(results, port) as second:
            assert second is None


@pytest.mark.parametrize("what", ["run", "table"])
def test_the_web_viewer_shows_a_run_and_the_catalogs_table(browser, results, tmp_path, what):
    words = [RUN] if what == "run" else ["task=balancing"]
    process, _ = browsing(results, *words)
    try:
        lines = iter(process.stdout.readline, b"")  # a line before may say that a port is in use
        address = next(
            found.group(1)
            for line in lines
            if (found := re.search(r"at (http://\S+)", line.decode()))
        )
        page, requests = opened(browser, address)
        page.wait_for_selector("canvas.visible", timeout=LONG)
        assert shows_something(page, tmp_path)
        # The rows come from the catalog, not from the server of the page.
        assert any("SegmentTable" in request or "rerun.cloud" in request for request in requests)
        page.close()
    finally:
        process.terminate()
        process.wait(20)
