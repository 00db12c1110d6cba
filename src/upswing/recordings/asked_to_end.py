"""Ctrl-C, and being asked to end (SIGTERM), as the end of a block and no failure.

A signal is noted, and heeded where we look for it: an exception that is raised by the signal itself, in
the midst of whatever runs, may be lost. LLVM and finalizers call Python and drop what it raises; and
after one that crossed an ``exec`` of numba's, Python ends itself by SIGINT even where it was caught.
"""

import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

from upswing.recordings.processes import Process

LOOKED_EVERY = 0.05
"""Between two looks whether a program still runs [s]."""

_noted: list[int] = []


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """The block ends where it next heeds a signal; a second one ends it at once."""
    # A shell may have switched Ctrl-C off.
    before = [(sign, signal.signal(sign, _note)) for sign in (signal.SIGINT, signal.SIGTERM)]
    _noted.clear()
    try:
        yield
    except KeyboardInterrupt:
        print()
    finally:
        for sign, handler in before:
            signal.signal(sign, handler)
        _noted.clear()


def heed() -> None:
    """``KeyboardInterrupt`` if the block was asked to end."""
    if _noted:
        raise KeyboardInterrupt


def wait_for(process: Process) -> None:
    """Wait until a program has ended, or the block was asked to end."""
    while process.poll() is None:
        heed()
        time.sleep(LOOKED_EVERY)


def _note(sign: int, _: FrameType | None) -> None:
    if _noted:
        raise KeyboardInterrupt
    _noted.append(sign)
