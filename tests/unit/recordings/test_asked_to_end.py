"""A signal ends a block and is no failure, wherever it comes."""

import ctypes
import os
import signal
import subprocess
import sys
import time

import pytest

from upswing.recordings.asked_to_end import ended_by_signals, heed, wait_for

CALLBACK = ctypes.CFUNCTYPE(None)


@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGTERM])
def test_it_is_not_lost_in_a_callback_from_foreign_code(sign, capsys):
    """What is raised there is dropped; LLVM calls Python so while it compiles."""

    @CALLBACK
    def foreign():
        os.kill(os.getpid(), sign)
        for _ in range(1_000):
            pass

    went_on = False
    with ended_by_signals():
        foreign()
        heed()
        went_on = True
    assert not went_on
    assert capsys.readouterr().out == "\n"


def test_without_one_nothing_is_heeded_and_handlers_are_as_before():
    before = [signal.getsignal(sign) for sign in (signal.SIGINT, signal.SIGTERM)]
    with ended_by_signals():
        heed()
    heed()
    assert [signal.getsignal(sign) for sign in (signal.SIGINT, signal.SIGTERM)] == before


def test_a_second_one_ends_it_at_once():
    begun = time.monotonic()
    with ended_by_signals():
        os.kill(os.getpid(), signal.SIGINT)
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(30)
    assert time.monotonic() - begun < 10


def test_who_waits_for_a_program_ends_with_it():
    with ended_by_signals(), subprocess.Popen([sys.executable, "-c", ""]) as process:
        wait_for(process)
        assert process.returncode == 0


ENDS_WELL = """
import os, signal
from upswing.recordings.asked_to_end import ended_by_signals, heed
with ended_by_signals():
    exec("os.kill(os.getpid(), signal.SIGINT)")
    heed()
raise SystemExit(0)
"""


def test_python_then_ends_as_it_was_told():
    """An exception that crosses an ``exec`` has Python end itself by SIGINT, though it was caught."""
    done = subprocess.run([sys.executable, "-c", ENDS_WELL], check=False, stdout=subprocess.DEVNULL)
    assert done.returncode == 0
