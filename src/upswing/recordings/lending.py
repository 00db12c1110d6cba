"""The report with every run's recording, while ``upswing browse`` runs: on loopback, behind a token.

The report opened from files can show the recordings that are kept beside it. Here it is served by us,
and a recording that is not kept is packed when it is asked for. Any page that a browser here shows can
ask at any port of this machine; so an answer is only for who asks at the address with the token that
``browse`` prints, by a name of this machine, and not from another site's page. Connections are bounded
in number and in time.
"""

import hmac
import mimetypes
import secrets
import socket
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any, NamedTuple
from urllib.parse import unquote, urlsplit

from upswing.recordings.ports import LOOPBACK
from upswing.recordings.singly import LAYOUTS, RECORDINGS, script_of_layout, script_of_run
from upswing.runs.results import Results
from upswing.study.ids import recording_id
from upswing.study.paths import PAGE, VIEWER

CONNECTIONS = 16
"""Largest number of connections at a time; one more is turned away."""

ASKING, ANSWERING = 5.0, 120.0
"""Time limits for a request to arrive, and for its answer to be taken [s]."""

SERVED = {".html", ".js", ".csv"}
"""What the report consists of."""

HEADERS = {
    "Cache-Control": "no-store",  # the address holds the token
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    # A page's own policy stands in the page; that nobody frames it can only be said here.
    "Content-Security-Policy": "frame-ancestors 'none'",
}


class Lent(NamedTuple):
    """Where the report is served."""

    port: int
    token: str

    @property
    def base(self) -> str:
        """The address below which everything is; only who knows it is answered."""
        return f"http://{LOOPBACK}:{self.port}/{self.token}/"

    @property
    def page(self) -> str:
        """The address of the report."""
        return self.base + PAGE


@contextmanager
def lending(results: Results, port: int) -> Iterator[Lent]:
    """Serve the report and every run's recording; at another port where ``port`` is in use."""
    token = secrets.token_urlsafe(32)
    try:
        server = _Server((LOOPBACK, port), results, token)
    except OSError:
        server = _Server((LOOPBACK, 0), results, token)
    thread = threading.Thread(target=server.serve_forever, args=(0.1,), daemon=True)
    thread.start()
    try:
        yield Lent(server.server_address[1], token)
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


class _Server(ThreadingHTTPServer):
    """Bounded in connections, and silent about those who leave early."""

    block_on_close = False  # an answer that is being taken does not keep us
    daemon_threads = True
    request_queue_size = 4 * CONNECTIONS  # those who wait to be let in, or turned away
    server_address: tuple[str, int]

    def __init__(self, address: tuple[str, int], results: Results, token: str) -> None:
        super().__init__(address, _Desk)
        self.results = results
        self.folder = results.folder.resolve()
        self.runs = {recording_id(run): run for run in results.runs["run"]}
        self.tasks = {cell.task.name for cell in results.cells.values()}
        self.token = token
        self.places = threading.BoundedSemaphore(CONNECTIONS)

    def process_request(self, request: Any, client_address: Any) -> None:
        if self.places.acquire(blocking=False):
            super().process_request(request, client_address)
        else:
            self.shutdown_request(request)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        try:
            super().process_request_thread(request, client_address)
        finally:
            self.places.release()

    def handle_error(self, *_: Any) -> None:
        error = sys.exception()
        if not isinstance(error, (ConnectionError, TimeoutError)):
            print(f"upswing: the report's server: {error!r}", flush=True)


class _Desk(BaseHTTPRequestHandler):
    """Answers one request of one connection."""

    server: _Server
    server_version, sys_version = "upswing", ""
    timeout = ASKING

    def setup(self) -> None:
        super().setup()
        self.cut = self._cut_after(ASKING)

    def finish(self) -> None:
        self.cut.cancel()
        super().finish()

    def do_GET(self) -> None:
        self._answer()

    def do_HEAD(self) -> None:
        self._answer()

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing of what was asked for."""

    def _answer(self) -> None:
        self.cut.cancel()
        self.cut = self._cut_after(ANSWERING)
        if not self._is_ours():
            self.send_error(403)
            return
        token, _, place = unquote(urlsplit(self.path).path).removeprefix("/").partition("/")
        if not hmac.compare_digest(token.encode(), self.server.token.encode()):
            self.send_error(403)
            return
        try:
            content = self._content(place)
        except (OSError, RuntimeError) as error:
            print(f"upswing: {error}", flush=True)
            self.send_error(500)
            return
        if content is None:
            self.send_error(404)
            return
        kind = "text/javascript" if place.endswith(".js") else mimetypes.guess_type(place)[0]
        self.send_response(200)
        self.send_header("Content-Type", f"{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(content)))
        self.end_headers()
        if self.command == "GET":
            self.wfile.write(content)

    def end_headers(self) -> None:
        for name, value in HEADERS.items():
            self.send_header(name, value)
        super().end_headers()

    def _is_ours(self) -> bool:
        """Whether it is asked by a name of this machine, and not from a page of another origin."""
        port = self.server.server_address[1]
        own = [f"{LOOPBACK}:{port}", f"localhost:{port}"]
        hosts = self.headers.get_all("Host", [])
        if len(hosts) != 1 or hosts[0] not in own:
            return False
        # Browsers say where a request comes from; "none" is an address that somebody typed or opened.
        if self.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin"):
            return False
        return self.headers.get("Origin", f"http://{hosts[0]}") == f"http://{hosts[0]}"

    def _content(self, place: str) -> bytes | None:
        """What is at a place below the results; None if it is not served."""
        server = self.server
        path = Path(place)
        # Of this study, or of one in a folder below: its report, and nothing else.
        if path.suffix not in SERVED or "report" not in path.parts[:2] or ".." in path.parts:
            return None
        with suppress(ValueError):  # a zero byte
            file = (server.folder / path).resolve()
            if file.is_relative_to(server.folder) and file.is_file():
                return file.read_bytes()
        # What is not kept is made: of every run, by its name.
        if path.parent == Path(VIEWER, RECORDINGS) and path.stem in server.runs:
            return script_of_run(server.results, server.runs[path.stem]).encode("ascii")
        if path.parent == Path(VIEWER, LAYOUTS) and path.stem in server.tasks:
            return script_of_layout(server.results, path.stem).encode("ascii")
        return None

    def _cut_after(self, seconds: float) -> threading.Timer:
        """End the connection, whoever is slow."""

        def cut() -> None:
            with suppress(OSError):
                self.connection.shutdown(socket.SHUT_RDWR)

        timer = threading.Timer(seconds, cut)
        timer.daemon = True
        timer.start()
        return timer
