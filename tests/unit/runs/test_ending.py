"""Asked to end while it holds its lock, Snakemake's scheduler ends all the same."""

import subprocess
import sys

from tests.workflow.small_study import Study
from upswing.runs.ending import GO_ON

PROGRAM = """
import os, signal, threading, time
from upswing.runs.ending import answer_in_a_thread
{mended}
from snakemake.scheduling.job_scheduler import JobScheduler

class Scheduler(JobScheduler):
    def __init__(self):
        self._lock, self._open_jobs, self._user_kill = threading.Lock(), threading.Semaphore(0), None

scheduler = Scheduler()
signal.signal(signal.SIGTERM, scheduler.exit_gracefully)
with scheduler._lock:
    os.kill(os.getpid(), signal.SIGTERM)
    time.sleep(0.2)
assert scheduler._open_jobs.acquire(timeout=10)
print(scheduler._user_kill)
"""


def said(mended, timeout):
    return subprocess.run(
        [sys.executable, "-c", PROGRAM.format(mended=mended)],
        capture_output=True, text=True, check=True, timeout=timeout,
    ).stdout  # fmt: skip


def test_it_does_not_wait_for_itself():
    assert said("answer_in_a_thread(); answer_in_a_thread()", 30) == "graceful\n"


def test_a_run_that_fails_ends_with_how_to_go_on(tmp_path):
    study = Study(tmp_path)
    (tmp_path / "results").mkdir()
    (tmp_path / "results/study.json").mkdir()  # the job cannot write its file
    (tmp_path / "results/study.json/in-the-way").touch()
    done = study.snakemake("--", "results/tables/runs.parquet")
    assert done.returncode != 0
    assert done.stderr.splitlines()[-1] == GO_ON
