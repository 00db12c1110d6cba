"""Waiting for a viewer that was just started."""

import time

from upswing.recordings.asked_to_end import LOOKED_EVERY, heed
from upswing.recordings.ports import listens
from upswing.recordings.processes import Process
from upswing.recordings.program import RERUN

PATIENCE = 20.0
"""Time limit for a viewer to start [s]."""


def wait_until_listening(process: Process, *ports: int) -> None:
    """Wait until a viewer answers at all of its ports.

    Raises:
        RuntimeError: it has ended, or takes too long.
        KeyboardInterrupt: we were asked to end meanwhile.
    """
    until = time.monotonic() + PATIENCE
    while not all(map(listens, ports)):
        if process.poll() is not None or time.monotonic() > until:
            raise RuntimeError(f"{RERUN.name}: the viewer did not start")
        heed()
        time.sleep(LOOKED_EVERY)
