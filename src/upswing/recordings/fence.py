"""A fence around the viewer's page: it asks this machine, and nobody else.

The page that Rerun serves looks for fonts, news and a catalog of its own in the network. Nothing depends
on them. Here it is handed on with a policy under which a browser does not even ask.
"""

import http.client
import re
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

from upswing.recordings.ports import LOOPBACK

PATIENCE = 20.0
"""Time limit for a request [s]."""

HANDED_ON = ("Content-Type", "Content-Encoding", "rerun-final-length")

ELSEWHERE = re.compile(rb'<link\s[^>]*"https?://[^>]*>')
"""What a page has a browser connect to before any policy is asked."""


@contextmanager
def fenced(port: int, inner: int, stream: int) -> Iterator[None]:
    """Serve the viewer's page on 127.0.0.1 during the block.

    Args:
        port: where it is served.
        inner: where the viewer serves it.
        stream: where what it shows comes from.
    """
    server = _Server((LOOPBACK, port), _Door)
    server.inner = inner
    server.policy = _policy(stream)
    thread = threading.Thread(target=server.serve_forever, args=(0.1,), daemon=True)
    thread.start()
    try:
        yield
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


def _policy(stream: int) -> str:
    here = f"http://{LOOPBACK}:{stream} http://localhost:{stream}"
    return "; ".join(
        [
            "default-src 'none'",
            "script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'",
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "worker-src 'self' blob:",
            f"connect-src 'self' data: blob: {here}",
            "base-uri 'none'",
            "form-action 'none'",
            "frame-ancestors 'none'",
        ]
    )


class _Server(ThreadingHTTPServer):
    """Silent about those who leave early."""

    block_on_close = False
    daemon_threads = True
    server_address: tuple[str, int]
    inner: int
    policy: str

    def handle_error(self, *_: Any) -> None:
        """Say nothing: a browser that is closed lets go of what it asked for."""


class _Door(BaseHTTPRequestHandler):
    """Hands on one request."""

    server: _Server
    server_version, sys_version = "upswing", ""
    timeout = PATIENCE

    def do_GET(self) -> None:
        port = self.server.server_address[1]
        if self.headers.get("Host") not in (f"{LOOPBACK}:{port}", f"localhost:{port}"):
            self.send_error(403)  # a page of another name, which only seems to be on this machine
            return
        inner = http.client.HTTPConnection(LOOPBACK, self.server.inner, timeout=PATIENCE)
        try:
            inner.request("GET", self.path)
            answer = inner.getresponse()
            content = answer.read()
            if "html" in answer.getheader("Content-Type", ""):
                content = ELSEWHERE.sub(b"", content)
        except (OSError, http.client.HTTPException):
            self.send_error(502)
            return
        finally:
            inner.close()
        self.send_response(answer.status)
        for name in HANDED_ON:
            if value := answer.getheader(name):
                self.send_header(name, value)
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Content-Security-Policy", self.server.policy)
        self.send_header("Referrer-Policy", "no-referrer")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.end_headers()
        with suppress(ConnectionError):
            self.wfile.write(content)

    def log_message(self, format: str, *args: object) -> None:
        """Say nothing of what was asked for."""
