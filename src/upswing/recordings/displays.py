"""Whether a window can be opened here, and how to see a page of this machine where none can."""

import os
import socket
import sys
from collections.abc import Sequence

from upswing.recordings.ports import LOOPBACK
from upswing.study.errors import BadInput


def has_display() -> bool:
    """Whether a window can be opened."""
    if sys.platform != "linux":
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def check_display(instead: str) -> None:
    """``BadInput`` if no window can be opened, with what there is instead."""
    if not has_display():
        raise BadInput([f"there is no display here; {instead}"])


def tunnel(ports: Sequence[int]) -> str:
    """The command that brings ports of this machine to the one before which somebody sits."""
    ways = " ".join(f"-L {port}:{LOOPBACK}:{port}" for port in ports)
    return f"ssh -N {ways} {socket.gethostname()}"
