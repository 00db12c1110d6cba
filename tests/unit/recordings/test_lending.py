"""The report as ``upswing browse`` serves it: every run opens, and nobody else is answered."""

import http.client
import socket
import threading
import time
from contextlib import closing
from pathlib import Path

import pytest

from tests.unit.recordings.pages import LONG, opened, shows_something, unpacked
from upswing.recordings import lending as lending_module
from upswing.recordings.lending import lending
from upswing.recordings.ports import listens
from upswing.report.page import write_report
from upswing.study.ids import recording_id
from upswing.study.paths import VIEWER

RUN = "full-control/modular-networks-5/alpha-1/seed-0"


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
        if not (results.folder / VIEWER / "recordings" / f"{recording_id(run)}.js").exists()
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
            assert taken < (results.folder / VIEWER / "engine.js").stat().st_size
        for one in idle:
            one.close()
