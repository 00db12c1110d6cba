"""Recordings in a browser: from plain files, as `upswing browse` serves the report, from the catalog."""

import base64
import gzip
import http.client
import os
import re
import socket
import subprocess
import threading
import time
from contextlib import closing
from pathlib import Path

import pytest
from PIL import Image

from tests.unit.runs.test_recording import browsing
from upswing.recordings import engine as engine_module
from upswing.recordings import lending as lending_module
from upswing.recordings.comparison import write_comparisons
from upswing.recordings.engine import FILES, engine
from upswing.recordings.lending import lending
from upswing.recordings.names import VIEWER
from upswing.recordings.policies import source_of
from upswing.recordings.ports import listens
from upswing.recordings.singly import chosen_runs, script_of_layout, script_of_run
from upswing.recordings.viewer import FOLDER, write_viewer
from upswing.report.page import write_report
from upswing.study.ids import recording_id

RUN = "full-control/modular-networks-5/alpha-1/seed-0"
LONG = 90_000
"""A browser that draws in software has so long to show a recording [ms]."""


@pytest.fixture(scope="module")
def names(results):
    """The names of the recordings beside the report, which are written."""
    write_comparisons(results)
    return write_viewer(results, Path("report"))


def unpacked(script):
    name, packed, layout = re.fullmatch(
        r'arrived\("([\w-]+)","([\w+/=]+)","([\w-]*)"\)\n', script
    ).groups()
    return name, gzip.decompress(base64.b64decode(packed)), layout


def test_a_recording_handed_out_is_the_runs_own_file_and_names_its_layout(results, tmp_path):
    script = script_of_run(results, RUN)
    name, content, layout = unpacked(script)
    assert (name, layout) == (recording_id(RUN), "full-control")
    assert content == (results.folder / "runs" / f"{RUN}.rrd").read_bytes()
    assert script_of_run(results, RUN) == script
    _, layout, _ = unpacked(script_of_layout(results, "full-control"))
    assert b"Phase plane, policy" in layout
    file = tmp_path / "layout.rbl"
    file.write_bytes(layout)
    done = subprocess.run([VIEWER, "rrd", "verify", file], capture_output=True, check=False)
    assert done.returncode == 0


def test_a_run_without_a_recording_is_named(results):
    missing = "balancing/table/alpha-1/seed-77"
    with pytest.raises(FileNotFoundError, match=r"seed-77\.rrd: missing"):
        script_of_run(results, missing)


def test_chosen_recordings_stand_beside_the_report(results, names):
    folder = results.folder / FOLDER
    assert {"task-balancing", "task-full-control", "claim-C1", "claim-C13"} <= set(names)
    assert {recording_id(run) for run in chosen_runs(results)} <= set(names)
    assert sorted(path.stem for path in (folder / "recordings").iterdir()) == sorted(names)
    assert not list(folder.parent.glob("*.part"))
    written = {path: path.read_bytes() for path in folder.rglob("*.js")}
    write_viewer(results, Path("report"))
    # Rerun gives a layout other ids each time; all else is the same.
    assert all(
        path.read_bytes() == content
        for path, content in written.items()
        if path.parent.name != "layouts"
    )


def test_the_viewers_page_allows_what_it_brings_and_nothing_else(results, names):
    page = (results.folder / FOLDER / "index.html").read_text("utf-8")
    policy = re.search(r'Content-Security-Policy" content="([^"]+)"', page)[1]
    assert "unsafe-inline" not in page
    assert "THE-" not in page
    assert "http" not in policy
    for element in ("script", "style"):
        (own,) = re.findall(rf"<{element}>(.*?)</{element}>", page, re.DOTALL)
        assert f"{element}-src" in policy
        assert source_of(own) in policy
    assert not re.search(r'\s(style|on\w+)="', page)


# The viewer's files, kept by version.


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """A cache of its own, and how often the viewer was asked for its files, which are small here."""
    asked = []
    monkeypatch.setattr(engine_module, "user_cache_path", lambda _: tmp_path / "cache")
    monkeypatch.setattr(
        engine_module, "_fetched", lambda: asked.append(1) or [b"script", b"program"]
    )
    return tmp_path / "cache", asked


def test_the_viewers_own_files_are_handed_out():
    script, program = engine_module._fetched()
    assert script.startswith(b"let wasm_bindgen")
    assert program.startswith(b"\0asm")


def kept(folder):
    return sorted(folder.rglob("*.gz"))


def test_the_viewers_files_are_fetched_once_for_a_version(cache, monkeypatch):
    folder, asked = cache
    first = engine()
    assert [gzip.decompress(packed) for packed in first] == [b"script", b"program"]
    assert engine() == first
    assert len(asked) == 1
    assert [path.stem for path in kept(folder)] == sorted(FILES)
    for path in kept(folder):
        assert path.stat().st_mode & 0o777 == 0o600
        assert path.parent.stat().st_mode & 0o777 == 0o700
    monkeypatch.setattr(engine_module, "version", lambda _: "77.0")
    assert engine() == first
    assert len(asked) == 2


def truncated(path):
    path.write_bytes(path.read_bytes()[:-1])


def one_bit(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(bytes(content))


def writable_by_others(path):
    path.chmod(0o666)


def of_somebody_else(path):
    if os.geteuid():
        pytest.skip("only root can give a file away")
    os.chown(path, 65534, 65534)


def a_link(path):
    path.rename(path.with_name("elsewhere"))
    path.symlink_to("elsewhere")


def a_folder_for_all(path):
    path.parent.chmod(0o777)


@pytest.mark.parametrize(
    "change", [truncated, one_bit, writable_by_others, of_somebody_else, a_link, a_folder_for_all]
)
def test_what_is_kept_is_not_used_if_it_is_damaged_or_could_be_anothers(cache, change):
    folder, asked = cache
    first = engine()
    change(kept(folder)[1])
    assert engine() == first
    assert len(asked) == 2
    if change is not a_folder_for_all:  # then it was kept anew
        assert engine() == first
        assert len(asked) == 2


def test_without_a_cache_it_is_fetched(cache, tmp_path):
    folder, asked = cache
    folder.write_text("a file")
    assert engine() == engine()
    assert len(asked) == 2


def test_what_another_program_answers_is_not_taken_for_the_viewers(tmp_path, monkeypatch):
    folder = tmp_path / "cache"
    monkeypatch.setattr(engine_module, "user_cache_path", lambda _: folder)
    monkeypatch.setattr(engine_module, "_answered", lambda _: b"alert(1)")
    with pytest.raises(RuntimeError, match="answered with what is not of"):
        engine()
    assert kept(folder) == []


# In a browser.


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
    page, _ = opened(browser, f"{(results.folder / FOLDER / 'index.html').as_uri()}#{name}")
    page.get_by_text(expected).wait_for(timeout=10_000)
    assert page.locator("img").count() == 0
    page.close()


def test_the_page_from_a_file_loads_nothing_from_a_port(browser, results, names):
    """Whoever holds a port of this machine is not asked for scripts."""
    asked = []
    page = browser.new_page()
    page.on("request", lambda request: asked.append(request.url))
    page.goto(f"{(results.folder / FOLDER / 'index.html').as_uri()}#no-such-run")
    page.get_by_text("make browse").wait_for(timeout=10_000)
    assert all(address.startswith("file://") for address in asked)
    page.close()
    for path in (*Path("report").rglob("*.html"), *Path("report").glob("*.js")):
        assert not re.search(r"https?://|localhost|127\.0", path.read_text("utf-8")), path


# The report as `upswing browse` serves it.


@pytest.fixture(scope="module")
def served(results, names):
    """The report of the study, served."""
    write_report(results.folder, Path("report"))
    with lending(results, 0) as lent:
        yield lent


def test_the_served_report_opens_every_run(browser, results, names, served, tmp_path):
    missing = next(run for run in results.runs["run"] if recording_id(run) not in names)
    page, requests = opened(browser, served.page)
    said = []
    page.on("console", lambda message: said.append(message.text))
    page.locator(f"#runs-table a[href$='#{recording_id(missing)}']").click()
    page.wait_for_selector("body[data-state=open]", timeout=LONG)
    assert shows_something(page, tmp_path)
    assert f"{served.base}report/viewer/recordings/{recording_id(missing)}.js" in requests
    assert all(address.startswith((served.base, "data:", "blob:")) for address in requests)
    # The viewer asks elsewhere for news of itself, which is refused; no script or style of ours is.
    assert [words for words in said if "script-src" in words or "style-src" in words] == []
    assert all("onnect" in words for words in said if "Security Policy" in words)
    page.close()


def test_a_page_of_another_origin_gets_nothing_even_with_the_token(browser, results, served):
    """What a browser says of the request decides, and what the answer says of itself."""
    address = f"{served.base}report/viewer/recordings/{recording_id(RUN)}.js"
    page = browser.new_page()
    page.goto("data:text/html,<title>elsewhere</title>")
    loaded = page.evaluate(
        """(address) => new Promise((done) => {
          window.arrived = () => done("read");
          const script = document.createElement("script");
          script.src = address;
          script.onload = () => done("loaded");
          script.onerror = () => done("refused");
          document.head.append(script);
        })""",
        address,
    )
    assert loaded == "refused"
    page.close()


def asked(port, path, method="GET", **headers):
    with closing(http.client.HTTPConnection("127.0.0.1", port, timeout=10)) as connection:
        connection.putrequest(method, path, skip_host="Host" in headers)
        for name, value in headers.items():
            connection.putheader(name.replace("_", "-"), value)
        connection.endheaders()
        reply = connection.getresponse()
        return reply.status, reply.read(), dict(reply.getheaders())


def test_it_answers_with_the_token_and_says_how_it_may_be_used(results, served):
    path = f"/{served.token}/report/viewer/recordings/{recording_id(RUN)}.js"
    status, content, headers = asked(served.port, path)
    assert status == 200
    assert unpacked(content.decode("ascii"))[0] == recording_id(RUN)
    assert headers["Content-Type"].startswith("text/javascript")
    assert headers["X-Content-Type-Options"] == "nosniff"
    assert headers["Cross-Origin-Resource-Policy"] == "same-origin"
    assert headers["Referrer-Policy"] == "no-referrer"
    assert headers["Cache-Control"] == "no-store"
    assert "Access-Control-Allow-Origin" not in headers
    assert asked(served.port, path, "HEAD")[:2] == (200, b"")
    for kind, file in (("text/html", "index.html"), ("text/csv", "runs.csv")):
        status, content, headers = asked(served.port, f"/{served.token}/report/{file}")
        assert status == 200
        assert headers["Content-Type"].startswith(kind)
        assert content == (results.folder / "report" / file).read_bytes()


@pytest.mark.parametrize(
    "headers",
    [
        {"Host": "elsewhere.example"},
        {"Host": "elsewhere.example:{port}"},
        {"Host": "127.0.0.1"},
        {"Host": "127.0.0.1:1"},
        {"Sec_Fetch_Site": "cross-site"},
        {"Sec_Fetch_Site": "same-site"},
        {"Origin": "null"},
        {"Origin": "http://127.0.0.1:1"},
        {"Origin": "https://elsewhere.example"},
    ],
)
def test_who_comes_from_elsewhere_is_refused(served, headers):
    given = {name: value.format(port=served.port) for name, value in headers.items()}
    status, content, answered = asked(served.port, f"/{served.token}/report/index.html", **given)
    assert status == 403
    assert b"upswing" not in content
    assert answered["X-Content-Type-Options"] == "nosniff"


def test_who_is_at_home_is_answered(served):
    for headers in (
        {"Sec_Fetch_Site": "same-origin", "Origin": f"http://127.0.0.1:{served.port}"},
        {"Sec_Fetch_Site": "none"},
        {"Host": f"localhost:{served.port}"},
    ):
        assert asked(served.port, f"/{served.token}/report/index.html", **headers)[0] == 200


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("/", 403),
        ("/report/index.html", 403),
        ("/{other}/report/index.html", 403),
        ("//report/index.html", 403),
        ("/é/report/index.html", 403),
        ("/{token}/study.json", 404),
        ("/{token}/tables/runs.parquet", 404),
        ("/{token}/report/../study.json", 404),
        ("/{token}/report/../tables/secret.csv", 404),
        ("/{token}/report/%2e%2e/tables/secret.csv", 404),
        ("/{token}/report/..%2ftables/secret.csv", 404),
        ("/{token}//etc/report/x.html", 404),
        ("/{token}/report/link.csv", 404),
        ("/{token}/report/%00.html", 404),
        ("/{token}/report/viewer/recordings/no-such-run.js", 404),
        ("/{token}/report/viewer/layouts/no-such-task.js", 404),
    ],
)
def test_nothing_but_the_report_is_served(results, served, tmp_path, path, expected):
    secret = results.folder / "tables/secret.csv"
    link = results.folder / "report/link.csv"
    outside = tmp_path / "outside.csv"
    for file in (secret, outside):
        file.write_text("a,b\n", "utf-8")
    link.symlink_to(outside)
    try:
        address = path.format(token=served.token, other="x" * len(served.token))
        assert asked(served.port, address.replace("é", "%C3%A9"))[0] == expected
    finally:
        secret.unlink()
        link.unlink()


def test_a_token_is_of_one_session_and_a_port_that_is_taken_is_left_alone(results, served):
    with lending(results, served.port) as second:
        assert second.port != served.port
        assert second.token != served.token
        assert len(second.token) >= 40
    assert not listens(second.port)


def test_what_cannot_be_read_is_said_in_one_line(results, served, monkeypatch, capfd):
    def gone(*_):
        raise OSError("gone")

    monkeypatch.setattr(lending_module, "script_of_run", gone)
    missing = next(
        run
        for run in results.runs["run"]
        if not (results.folder / FOLDER / "recordings" / f"{recording_id(run)}.js").exists()
    )
    path = f"/{served.token}/report/viewer/recordings/{recording_id(missing)}.js"
    assert asked(served.port, path)[0] == 500
    assert capfd.readouterr().out == "upswing: gone\n"


def hello(lent, method="GET"):
    path = f"/{lent.token}/report/viewer/engine.js"
    return f"{method} {path} HTTP/1.0\r\nHost: 127.0.0.1:{lent.port}\r\n\r\n".encode()


def test_who_leaves_early_prints_nothing(results, served, capfd):
    for _ in range(5):
        with socket.create_connection(("127.0.0.1", served.port)) as client:
            client.sendall(hello(served))
            client.recv(10)
            # It goes with a reset, while megabytes are on their way.
            client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
    with socket.create_connection(("127.0.0.1", served.port)) as client:
        client.sendall(b"GET /half")
    time.sleep(0.5)
    assert capfd.readouterr() == ("", "")
    assert asked(served.port, f"/{served.token}/report/index.html")[0] == 200


def test_connections_are_bounded_in_number_and_time(results, names, monkeypatch):
    monkeypatch.setattr(lending_module, "ASKING", 1.0)
    monkeypatch.setattr(lending_module, "ANSWERING", 2.0)
    with lending(results, 0) as lent:
        idle = [socket.create_connection(("127.0.0.1", lent.port), 5) for _ in range(40)]
        time.sleep(0.3)
        busy = [one for one in threading.enumerate() if "process_request_thread" in one.name]
        assert len(busy) == lending_module.CONNECTIONS
        # Those who say nothing, or a letter now and then, are cut off, and there is room again.
        slow = idle[0]
        began = time.monotonic()
        try:
            while time.monotonic() - began < 5:
                slow.sendall(b"G")
                time.sleep(0.1)
        except OSError:
            pass
        assert time.monotonic() - began < 3
        assert asked(lent.port, "/")[0] == 403
        # So is who asks and does not take the answer.
        with socket.socket() as client:
            client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            client.connect(("127.0.0.1", lent.port))
            client.sendall(hello(lent))
            time.sleep(3)
            client.settimeout(5)
            taken = 0
            try:
                while piece := client.recv(1 << 20):
                    taken += len(piece)
            except OSError:
                pass
            assert taken < (results.folder / FOLDER / "engine.js").stat().st_size
        for one in idle:
            one.close()


@pytest.mark.parametrize("what", ["run", "table"])
def test_the_web_viewer_shows_a_run_and_the_catalogs_table(browser, results, tmp_path, what):
    words = [RUN] if what == "run" else ["task=balancing"]
    process, _ = browsing(results, *words)
    try:
        lines = iter(process.stdout.readline, b"")  # a line before may say that a port is in use
        address = next(
            found.group(1)
            for line in lines
            if (found := re.search(r"runs? at (http://\S+)", line.decode()))
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
