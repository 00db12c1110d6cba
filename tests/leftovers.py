"""What a session of tests has started and left running: none, or the run fails."""

import os
import secrets
import time
from collections.abc import Iterator
from contextlib import suppress

import psutil
import pytest

MARK = "UPSWING_TESTS_SESSION"
PATIENCE = 10.0
"""What is ending has so long [s]."""


def born_with(mark: str) -> list[psutil.Process]:
    """The processes, other than this one, whose environment has the mark or that descend from this one."""
    found = {process.pid: process for process in psutil.Process().children(recursive=True)}
    for process in psutil.process_iter():
        with suppress(psutil.Error):  # it has ended, or is another user's
            if process.environ().get(MARK) == mark:
                found[process.pid] = process
    found.pop(os.getpid(), None)
    living = []
    for process in found.values():
        with suppress(psutil.Error):
            if process.status() != psutil.STATUS_ZOMBIE:
                living.append(process)
    return living


@pytest.fixture(scope="session", autouse=True)
def _nothing_left_running() -> Iterator[None]:
    """Fail the run if a process born in it still lives; under xdist each worker looks after its own."""
    mark = secrets.token_hex(8)
    before = os.environ.get(MARK)
    os.environ[MARK] = mark
    # Python's own watcher of shared memory lives as long as the interpreter.
    older = {process.pid for process in psutil.Process().children(recursive=True)}
    yield
    until = time.monotonic() + PATIENCE
    while left := [one for one in born_with(mark) if one.pid not in older]:
        if time.monotonic() > until:
            break
        time.sleep(0.1)
    if before is None:
        del os.environ[MARK]
    else:
        os.environ[MARK] = before
    said = []
    for process in left:
        with suppress(psutil.Error):
            said.append(f"{process.pid}: {' '.join(process.cmdline())[:200]}")
            process.kill()
    if said:
        pytest.fail("\n".join(["left running by these tests (now killed):", *said]), pytrace=False)
