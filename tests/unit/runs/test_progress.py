"""Progress in a log file: some lines for a whole run, and every failure."""

import logging

import pytest
from snakemake_interface_logger_plugins.common import LogEvent

from upswing.runs.progress import LINES, NowAndThen


def record(event=None, level=logging.INFO, text="", **more):
    made = logging.LogRecord("snakemake", level, "", 0, text, None, None)
    made.__dict__.update(event=event, **more)
    return made


def test_of_many_jobs_some_lines_are_said():
    said, kept = NowAndThen(), []
    for done in range(1, 3_501):
        assert not said.filter(record(text="Execute 2 jobs..."))
        assert not said.filter(record(LogEvent.JOB_INFO))
        assert not said.filter(record(LogEvent.JOB_FINISHED))
        if said.filter(record(LogEvent.PROGRESS, done=done, total=3_500)):
            kept.append(done)
    assert LINES <= len(kept) <= LINES + 1
    assert kept[-1] == 3_500


@pytest.mark.parametrize("total", [1, 7, 19])
def test_of_few_jobs_each_is_said(total):
    said = NowAndThen()
    assert all(
        said.filter(record(LogEvent.PROGRESS, done=done, total=total))
        for done in range(1, total + 1)
    )


def test_what_failed_what_is_warned_of_and_what_is_to_come_is_said():
    said = NowAndThen()
    assert said.filter(record(LogEvent.JOB_ERROR, logging.ERROR))
    assert said.filter(record(None, logging.WARNING, "Execute it by hand"))
    assert said.filter(record(LogEvent.RUN_INFO))
    assert said.filter(record(None, text="Complete log(s): here"))
