"""The end of Snakemake: its last words, and its answer to being asked to end (SIGTERM).

It must not wait for itself. Snakemake 9 takes a lock in its signal handler, which runs in the thread
that may hold this very lock: it then neither ends nor goes on. In a thread of its own the handler waits
until the lock is free.
"""

import atexit
import sys
from threading import Thread
from typing import Any

GO_ON = (
    "upswing: stopped before the end. What is finished stays, "
    "and the same command goes on from there."
)
"""Said where jobs failed or somebody interrupted them."""


def answer_in_a_thread() -> None:
    """Have Snakemake's scheduler, before there is one, answer SIGTERM in a thread of its own."""
    from snakemake.scheduling.job_scheduler import JobScheduler

    answer = JobScheduler.exit_gracefully
    if answer.__module__ == __name__:  # a workflow may be read twice
        return

    def exit_gracefully(scheduler: Any, *signal: Any) -> None:
        Thread(target=answer, args=(scheduler, *signal), daemon=True).start()

    JobScheduler.exit_gracefully = exit_gracefully


def say_last(words: str) -> None:
    """Say something when all else has been said, what Snakemake says of its own end too."""
    atexit.register(print, words, file=sys.stderr, flush=True)
