"""Foreign programs end with us: after the block, by an exception, by every signal; and so do those of tests."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from tests.leftovers import MARK, born_with
from upswing.recordings.processes import finished, running

SLEEP = [sys.executable, "-c", "import time; time.sleep(300)"]
SHELL = ["sh", "-c", "sleep 301 & exec sleep 302"]
"""A program that starts one other, and so is all there when that is."""


def family(pid):
    """A process and what it has started, when both are there."""
    until = time.monotonic() + 10
    while time.monotonic() < until:
        found = [psutil.Process(pid), *psutil.Process(pid).children(recursive=True)]
        if len(found) > 1:
            return found
        time.sleep(0.02)
    pytest.fail("it started nothing")


def gone(processes):
    _, alive = psutil.wait_procs(processes, timeout=10)
    return not [one for one in alive if one.status() != psutil.STATUS_ZOMBIE]


@pytest.mark.parametrize("how", ["end", "exception"])
def test_a_program_and_what_it_started_end_with_the_block(how):
    try:
        with running(SHELL) as process:
            members = family(process.pid)
            if how == "exception":
                raise ValueError
    except ValueError:
        pass
    assert gone(members)


def test_a_program_that_does_not_want_to_end_is_killed(monkeypatch):
    monkeypatch.setattr("upswing.recordings.processes.PATIENCE", 0.3)
    stubborn = "import signal, time; signal.signal(15, signal.SIG_IGN); print(1, flush=True); time.sleep(300)"
    with running([sys.executable, "-c", stubborn], stdout=subprocess.PIPE) as process:
        process.stdout.readline()
    assert process.returncode == -signal.SIGKILL


HOLDER = f"""
import sys
from upswing.recordings.processes import running
with running({SHELL!r}) as process:
    print(process.pid, flush=True)
    process.wait()
"""


@pytest.mark.parametrize(
    ("sign", "code"),
    [(signal.SIGTERM, 143), (signal.SIGHUP, 129), (signal.SIGINT, -2), (signal.SIGKILL, -9)],
)
def test_a_signal_to_us_ends_the_program(sign, code):
    if sign == signal.SIGKILL and sys.platform != "linux":
        pytest.skip("only Linux can kill a program with its parent")
    # A shell may have switched SIGINT off for us; a holder of its own has it.
    holder = subprocess.Popen(
        [sys.executable, "-c", f"import signal; signal.signal(2, signal.default_int_handler)\n{HOLDER}"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        members = family(int(holder.stdout.readline()))
        holder.send_signal(sign)
        assert holder.wait(15) == code
        # Killed outright, we leave no time for what a program has started; of ours, none starts any.
        assert gone(members[:1] if sign == signal.SIGKILL else members)
    finally:
        holder.kill()
        holder.wait()
        holder.stdout.close()
        for one in members:
            if one.is_running():
                one.kill()


def test_what_a_program_printed_and_why_it_failed():
    assert finished(["sh", "-c", "echo here"], 10) == b"here\n"
    with pytest.raises(RuntimeError, match=r"^no such luck$"):
        finished(["sh", "-c", "echo first >&2; echo no such luck >&2; exit 3"], 10)
    with pytest.raises(RuntimeError, match="exit code 3"):
        finished(["sh", "-c", "exit 3"], 10)
    with pytest.raises(RuntimeError, match=r"not done after 0\.2 s"):
        finished(SLEEP, 0.2)


def test_no_other_part_starts_a_program_that_stays():
    # git, and a job's own measurements, are waited for by subprocess.run.
    for path in Path("src/upswing").rglob("*.py"):
        text = path.read_text("utf-8")
        if path.name != "processes.py":
            assert "Popen" not in text, path
            assert "ViewerClient.spawn" not in text, path
            assert "os.spawn" not in text, path


# The tests themselves.

LEAVES = """
import subprocess, sys
def test_leaves():
    subprocess.Popen(["sh", "-c", "sleep 303 & exit 0"], start_new_session=True).wait()
"""
KEEPS = """
import subprocess
def test_keeps():
    with subprocess.Popen(["sleep", "304"]) as process:
        process.kill()
"""


@pytest.mark.parametrize(("test", "code"), [(LEAVES, 1), (KEEPS, 0)])
@pytest.mark.parametrize("workers", ["0", "2"])
def test_a_run_of_tests_fails_if_it_leaves_a_process(tmp_path, test, code, workers):
    (tmp_path / "conftest.py").write_text(
        "import tests.leftovers\ntests.leftovers.PATIENCE = 0.5\n"
        "from tests.leftovers import _nothing_left_running\n"
    )
    (tmp_path / "test_it.py").write_text(test)
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-q", "-n", workers, "-c", os.devnull, str(tmp_path)],
        env={**os.environ, "PYTHONPATH": str(Path.cwd())},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == code, done.stdout
    assert ("left running by these tests" in done.stdout) == bool(code)
    assert ("sleep 303" in done.stdout) == bool(code)


def test_a_process_is_found_by_its_mark_even_if_its_parent_is_gone():
    environment = {**os.environ, MARK: "a mark"}
    command = ["sh", "-c", "sleep 305 >/dev/null 2>&1 & echo $!"]
    said = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    child = psutil.Process(int(said.stdout))
    try:
        assert child in born_with("a mark")
    finally:
        child.kill()
    assert gone([child])
