"""Viewers that wait for what is streamed to them: a window, or a page for where there is no display."""

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple
from urllib.parse import quote

from upswing.recordings.asked_to_end import heed, wait_for
from upswing.recordings.displays import check_display, tunnel
from upswing.recordings.fence import fenced
from upswing.recordings.ports import LOOPBACK, check_free, free_port
from upswing.recordings.processes import Process, running
from upswing.recordings.program import RERUN
from upswing.recordings.starting import wait_until_listening


class Looking(NamedTuple):
    """Somebody who looks."""

    url: str  # where a stream is sent
    says: str  # where it is seen, and how that ends
    process: Process

    @property
    def looks(self) -> bool:
        """Whether the viewer is still there; ``KeyboardInterrupt`` if we were asked to end."""
        heed()
        return self.process.poll() is None

    def until_closed(self) -> None:
        """Wait until the viewer is closed."""
        wait_for(self.process)


@contextmanager
def window() -> Iterator[Looking]:
    """Open a window; it is closed after the block.

    Raises:
        BadInput: there is no display.
        RuntimeError: it cannot be opened.
    """
    check_display("--web serves a page instead")
    port = free_port()
    command = [str(RERUN), "--bind", LOOPBACK, "--port", str(port), "--expect-data-soon"]
    with running(command) as process:
        wait_until_listening(process, port)
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
        wait_until_listening(process, port, inner)
        address = f"http://{LOOPBACK}:{web_port}/?url={quote(_url(port), safe='')}"
        elsewhere = f"From another computer, say there first: {tunnel([web_port, port])}"
        yield Looking(_url(port), f"at {address}\n{elsewhere}\nCtrl-C ends it.", process)


def _url(port: int) -> str:
    return f"rerun+http://{LOOPBACK}:{port}/proxy"
