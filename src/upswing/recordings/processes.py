"""Foreign programs: whatever is started here has ended before we have, however we end.

A program runs in a session of its own, so that it ends with all that it has started itself. It ends when
its block does, by an exception too; asked to end (SIGTERM, a terminal that is closed), we end it first.
Killed outright, we can end nothing, and so on Linux the kernel is asked beforehand to kill it with us.
"""

import ctypes
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from types import FrameType
from typing import IO

PATIENCE = 5.0
"""Time between asking a program to end and killing it [s]."""

_PR_SET_PDEATHSIG = 1
_ASKED_TO_END = (signal.SIGTERM, signal.SIGHUP)
_prctl: Callable[..., int] | None = (
    ctypes.CDLL(None, use_errno=True).prctl if sys.platform == "linux" else None
)


class AskedToEnd(SystemExit):
    """A signal has asked us to end; the exit code says which, as a shell's does."""

    def __init__(self, sign: int) -> None:
        super().__init__(128 + sign)


Process = subprocess.Popen[bytes]
"""A program that runs beside us."""


@contextmanager
def running(
    command: Sequence[str],
    *,
    stdout: int | IO[bytes] | None = None,
    stderr: int | IO[bytes] | None = None,
) -> Iterator[subprocess.Popen[bytes]]:
    """Run a program beside the block, and end it, with all that it started, after the block.

    Args:
        command: the program and its arguments; no shell reads them.
        stdout: as for ``subprocess.Popen``.
        stderr: as for ``subprocess.Popen``.
    """
    with _ending_orderly():
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=stdout,
            stderr=stderr,
            start_new_session=True,
            # It calls one function of C that is at hand already, which is safe beside other threads.
            preexec_fn=_die_with(os.getpid()),
        )
        try:
            yield process
        finally:
            _end(process)


def finished(command: Sequence[str], patience: float) -> bytes:
    """Run a program to its end; returns what it printed.

    Args:
        command: the program and its arguments; no shell reads them.
        patience: time limit [s].

    Raises:
        RuntimeError: it failed, in its own last words, or took too long.
    """
    with running(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        try:
            said, complained = process.communicate(timeout=patience)
        except subprocess.TimeoutExpired:
            raise RuntimeError(f"{command[0]}: not done after {patience:g} s") from None
    if process.returncode:
        words = complained.decode(errors="replace").strip().splitlines()
        raise RuntimeError(words[-1] if words else f"{command[0]}: exit code {process.returncode}")
    return said


def _end(process: subprocess.Popen[bytes]) -> None:
    """End a program and its session: asked first, then killed."""
    for pipe in (process.stdout, process.stderr):
        if pipe is not None:
            pipe.close()
    for sign in (signal.SIGTERM, signal.SIGKILL):
        # The session may be gone, or hold only what has ended and was not waited for (macOS).
        with suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, sign)
        with suppress(subprocess.TimeoutExpired):
            process.wait(PATIENCE)


def _die_with(parent: int) -> Callable[[], None] | None:
    """What a new program does before it begins: have itself killed when ``parent`` ends."""
    prctl = _prctl
    if prctl is None:
        return None

    def begin() -> None:
        prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0)
        if os.getppid() != parent:  # it has ended in the meantime
            os._exit(1)

    return begin


@contextmanager
def _ending_orderly() -> Iterator[None]:
    """A signal that would end us at once is an exception in the block."""

    def raise_it(sign: int, _: FrameType | None) -> None:
        raise AskedToEnd(sign)

    replaced = []
    if threading.current_thread() is threading.main_thread():
        replaced = [sign for sign in _ASKED_TO_END if signal.getsignal(sign) is signal.SIG_DFL]
    for sign in replaced:
        signal.signal(sign, raise_it)
    try:
        yield
    finally:
        for sign in replaced:
            signal.signal(sign, signal.SIG_DFL)
