"""Any run's recording for the report's viewer page, while ``upswing browse`` runs: on loopback alone.

The page can hold some recordings only; it asks here for the others, as scripts, since a page opened
from a file may load nothing else.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

from upswing.recordings.names import recording_id
from upswing.recordings.singly import script_of_run
from upswing.runs import Results

LOOPBACK = "127.0.0.1"
PORT = 9873
"""``report/viewer.html`` asks at this port."""


@contextmanager
def lending(results: Results, port: int = PORT) -> Iterator[int | None]:
    """Answer ``/NAME.js`` for every run; yields the port, or None where it is in use."""
    runs = {recording_id(run): run for run in results.runs["run"]}

    class Desk(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            # Another site's page, led here by a name of its own, is not served.
            if self.headers.get("Host", "").rsplit(":", 1)[0] not in (LOOPBACK, "localhost"):
                self.send_error(403)
                return
            run = runs.get(self.path.removeprefix("/").removesuffix(".js"))
            if run is None:
                self.send_error(404)
                return
            try:
                script = script_of_run(results, run).encode("ascii")
            except (OSError, RuntimeError) as error:
                print(f"upswing: {error}", flush=True)
                self.send_error(500)
                return
            self.send_response(200)
            self.send_header("Content-Type", "text/javascript")
            self.send_header("Content-Length", str(len(script)))
            self.send_header("Cache-Control", "no-store")
            self.end_headers()
            self.wfile.write(script)

        def log_message(self, format: str, *args: object) -> None:
            """Say nothing of what was asked for."""

    try:
        server = ThreadingHTTPServer((LOOPBACK, port), Desk)
    except OSError:
        yield None
        return
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        server.server_close()
