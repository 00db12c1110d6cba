"""Viewers that wait for what is streamed to them: a window, or a page for where there is no display."""

import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple
from urllib.parse import quote

from upswing.recordings.catalog import has_display, tunnel
from upswing.recordings.fence import fenced
from upswing.recordings.ports import LOOPBACK, check_free, free_port, listens
from upswing.recordings.processes import running
from upswing.recordings.program import RERUN
from upswing.study.errors import BadInput

PORT, WEB_PORT = 9874, 9875
"""Where a page's stream and the page itself are served, where nothing else is said."""

PATIENCE = 20.0
"""Time limit for a viewer to start [s]."""


class Looking(NamedTuple):
    """Somebody who looks."""

    url: str  # where a stream is sent
    says: str  # where it is seen, and how that ends
    process: "subprocess.Popen[bytes]"

    @property
    def looks(self) -> bool:
        """Whether the viewer is still there."""
        return self.process.poll() is None

    def until_closed(self) -> None:
        """Wait until the viewer is closed."""
        self.process.wait()


@contextmanager
def window() -> Iterator[Looking]:
    """Open a window; it is closed after the block.

    Raises:
        BadInput: there is no display.
        RuntimeError: it cannot be opened.
    """
    if not has_display():
        raise BadInput(["there is no display here; --web serves a page instead"])
    port = free_port()
    command = [str(RERUN), "--bind", LOOPBACK, "--port", str(port), "--expect-data-soon"]
    with running(command) as process:
        _started(process, port)
        says = "in the viewer: close it, or press Ctrl-C here, to end it."
        yield Looking(_url(port), says, process)


@contextmanager
def page(port: int, web_port: int) -> Iterator[Looking]:
    """Serve a page on 127.0.0.1; it ends after the block.

    Args:
        port: of the stream.
        web_port: of the page.

    Raises:
        BadInput: a port is in use.
        RuntimeError: it cannot be served.
    """
    check_free(port)
    check_free(web_port)
    inner = free_port()
    command = [str(RERUN), "--serve-web", "--bind", LOOPBACK, "--port", str(port)]
    with (
        running(
            [*command, "--web-viewer-port", str(inner)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        ) as process,
        fenced(web_port, inner, port),
    ):
        _started(process, port, inner)
        address = f"http://{LOOPBACK}:{web_port}/?url={quote(_url(port), safe='')}"
        elsewhere = f"From another computer, say there first: {tunnel([web_port, port])}"
        yield Looking(_url(port), f"at {address}\n{elsewhere}\nCtrl-C ends it.", process)


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Ctrl-C, and being asked to end, end the block and are no failure."""
    # A shell may have switched Ctrl-C off.
    before = [
        (sign, signal.signal(sign, signal.default_int_handler))
        for sign in (signal.SIGINT, signal.SIGTERM)
    ]
    try:
        yield
    except KeyboardInterrupt:
        print()
    finally:
        for sign, handler in before:
            signal.signal(sign, handler)


def _url(port: int) -> str:
    return f"rerun+http://{LOOPBACK}:{port}/proxy"


def _started(process: "subprocess.Popen[bytes]", *ports: int) -> None:
    """Wait until a viewer answers."""
    until = time.monotonic() + PATIENCE
    while not all(map(listens, ports)):
        if process.poll() is not None or time.monotonic() > until:
            raise RuntimeError(f"{RERUN.name}: the viewer did not start")
        time.sleep(0.05)
