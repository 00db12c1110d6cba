"""Progress of Snakemake in a pipe or a log file: a line now and then, for one of a number of jobs.

Snakemake says some ten lines of each job, and keeps all of them in ``.snakemake/log`` anyway.
"""

import logging
from typing import Any

LINES = 20
"""Number of lines for a whole run, about."""

OF_A_JOB = ("Select jobs to execute", "Execute ", "Resources before job selection")
"""How the lines begin that are of no event, and of one round of jobs."""


class NowAndThen(logging.Filter):
    """Lets through what is not of single jobs, jobs that failed, and one of every so many steps."""

    def __init__(self) -> None:
        super().__init__()
        self._said = 0

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether a line is said."""
        from snakemake_interface_logger_plugins.common import LogEvent

        event = getattr(record, "event", None)
        if event == LogEvent.PROGRESS:
            return self._is_due(record.__dict__["done"], record.__dict__["total"])
        if event is None:
            return record.levelno > logging.INFO or not record.getMessage().startswith(OF_A_JOB)
        return event not in (
            LogEvent.JOB_INFO, LogEvent.JOB_STARTED, LogEvent.JOB_FINISHED, LogEvent.GROUP_INFO,
            LogEvent.SHELLCMD, LogEvent.RESOURCES_INFO,
        )  # fmt: skip

    def _is_due(self, done: int, total: int) -> bool:
        every = max(1, total // LINES)
        if done < total and done // every == self._said // every:
            return False
        self._said = done
        return True


def say_now_and_then(workflow: Any) -> None:
    """Have Snakemake say less where no terminal reads it, unless it is asked for more or only plans."""
    asked = workflow.logger_manager.settings
    if asked.verbose or asked.printshellcmds or asked.dryrun or not workflow.is_main_process:
        return
    for handler in logging.getLogger("snakemake.logging").handlers:
        stream = getattr(handler, "stream", None)
        if handler.name == "DefaultStreamHandler" and stream is not None and not stream.isatty():
            handler.addFilter(NowAndThen())
