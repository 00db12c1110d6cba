"""A display without a screen, and closing windows on it as its user would: Xvfb, and Xlib by its C interface."""

import ctypes
import ctypes.util
import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

PATIENCE = 60.0
"""A window has so long to appear [s]."""

CLIENT_MESSAGE = 33


class _ClientMessage(ctypes.Structure):
    _fields_ = [
        ("type", ctypes.c_int), ("serial", ctypes.c_ulong), ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p), ("window", ctypes.c_ulong), ("message_type", ctypes.c_ulong),
        ("format", ctypes.c_int), ("data", ctypes.c_long * 5), ("room", ctypes.c_long * 24),
    ]  # fmt: skip


def why_not() -> str:
    """What is lacking for a display; empty if nothing is."""
    if shutil.which("Xvfb") is None:
        return "no Xvfb: install Debian's package xvfb"
    return "" if ctypes.util.find_library("X11") else "no libX11: install Debian's package libx11-6"


class Screen(NamedTuple):
    """A display of our own."""

    name: str  # as the variable DISPLAY has it
    memory: Path  # what it shows

    def shown(self) -> bytes:
        """What it shows now."""
        return self.memory.read_bytes()


@contextmanager
def display() -> Iterator[Screen]:
    """A display that lasts as long as the block."""
    reading, writing = os.pipe()
    with TemporaryDirectory() as folder:
        command = ["Xvfb", "-displayfd", str(writing), "-fbdir", folder, "-nolisten", "tcp"]
        command += ["-screen", "0", "1280x800x24"]
        with subprocess.Popen(command, pass_fds=[writing], stderr=subprocess.DEVNULL) as server:
            os.close(writing)
            try:
                with os.fdopen(reading) as said:
                    name = f":{said.readline().strip()}"
                yield Screen(name, Path(folder, "Xvfb_screen0"))
            finally:
                server.terminate()


class Windows:
    """The windows of a display that have a name."""

    def __init__(self, name: str) -> None:
        self._x = ctypes.CDLL(ctypes.util.find_library("X11"))
        for function in ("XOpenDisplay", "XDefaultRootWindow", "XInternAtom"):
            getattr(self._x, function).restype = ctypes.c_size_t
        self._display = ctypes.c_void_p(self._x.XOpenDisplay(name.encode()))
        assert self._display.value, f"{name}: no display"

    @property
    def named(self) -> dict[str, int]:
        """All of them by their names, at any depth."""
        found: dict[str, int] = {}
        self._look(self._x.XDefaultRootWindow(self._display), found)
        return found

    def wait_for(self, name: str) -> int:
        """The window of this name, as soon as it is there."""
        self.wait_until(lambda: name in self.named)
        return self.named[name]

    def wait_until(self, holds: Callable[[], bool]) -> None:
        """Wait until something holds."""
        until = time.monotonic() + PATIENCE
        while not holds():
            if time.monotonic() > until:
                raise TimeoutError(f"after {PATIENCE:g} s there are the windows {list(self.named)}")
            time.sleep(0.1)

    def close(self, window: int) -> None:
        """Ask a window to close, as the cross in its corner does."""
        message = _ClientMessage(
            type=CLIENT_MESSAGE, window=window, message_type=self._atom("WM_PROTOCOLS"), format=32
        )
        message.data[0] = self._atom("WM_DELETE_WINDOW")
        self._x.XSendEvent(
            self._display, ctypes.c_ulong(window), 0, ctypes.c_long(0), ctypes.byref(message)
        )
        self._x.XFlush(self._display)

    def _atom(self, name: str) -> int:
        return int(self._x.XInternAtom(self._display, name.encode(), 0))

    def _look(self, window: int, found: dict[str, int]) -> None:
        root, parent, number = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.c_uint()
        children, name = ctypes.POINTER(ctypes.c_ulong)(), ctypes.c_char_p()
        if (
            self._x.XFetchName(self._display, ctypes.c_ulong(window), ctypes.byref(name))
            and name.value
        ):
            found[name.value.decode(errors="replace")] = window
        if self._x.XQueryTree(
            self._display, ctypes.c_ulong(window), ctypes.byref(root), ctypes.byref(parent),
            ctypes.byref(children), ctypes.byref(number),
        ):  # fmt: skip
            for i in range(number.value):
                self._look(children[i], found)
