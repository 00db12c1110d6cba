"""Snakemake's answer to being asked to end (SIGTERM), so that it cannot wait for itself.

Snakemake 9 takes a lock in its signal handler, which runs in the thread that may hold this very lock: it
then neither ends nor goes on. In a thread of its own the handler waits until the lock is free.
"""

from threading import Thread
from typing import Any


def answer_in_a_thread() -> None:
    """Have Snakemake's scheduler, before there is one, answer SIGTERM in a thread of its own."""
    from snakemake.scheduling.job_scheduler import JobScheduler

    answer = JobScheduler.exit_gracefully
    if answer.__module__ == __name__:  # a workflow may be read twice
        return

    def exit_gracefully(scheduler: Any, *signal: Any) -> None:
        Thread(target=answer, args=(scheduler, *signal), daemon=True).start()

    JobScheduler.exit_gracefully = exit_gracefully
