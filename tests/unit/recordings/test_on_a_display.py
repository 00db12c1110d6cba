"""The viewer's window on a display: it is opened, and however it ends nothing is left running."""

import os
import signal
import subprocess
import sys
from contextlib import contextmanager

import psutil
import pytest

from tests.unit.display import Windows, display, why_not
from tests.unit.recordings.test_browsing import DRIVERS

pytestmark = [
    pytest.mark.heavy,  # it opens windows
    pytest.mark.skipif(bool(why_not()), reason=why_not()),
    pytest.mark.skipif(not DRIVERS, reason="no Vulkan driver: install mesa-vulkan-drivers"),
]

RUN = "balancing/table/alpha-0.1/seed-1"
LOADED = b"to be looked at, until"


@pytest.fixture(scope="module")
def screen():
    with display() as opened:
        yield opened.name


@contextmanager
def showing(screen, folder, *words):
    """A process that shows something in a window, its children, and the windows that there are."""
    surroundings = {**os.environ, "DISPLAY": screen, "XDG_RUNTIME_DIR": str(folder)}
    surroundings.pop("WAYLAND_DISPLAY", None)
    process = subprocess.Popen(
        [sys.executable, "-m", "upswing.cli", *words],
        env=surroundings, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    try:
        windows = Windows(screen)
        window = windows.wait_for("Rerun")
        yield process, window, windows, psutil.Process(process.pid).children(recursive=True)
    finally:
        process.kill()
        process.wait(20)


@pytest.mark.parametrize("speed", ["real", "fast"])  # in the midst of it, and after its end
@pytest.mark.parametrize("how", ["closed", "Ctrl-C"])
def test_a_watched_run_ends_with_its_window(results, screen, tmp_path, speed, how):
    words = ["watch", RUN, "--speed", speed, "--results", str(results.folder)]
    with showing(screen, tmp_path, *words) as (process, window, windows, children):
        said = process.stdout.readline()
        if speed == "fast":
            while LOADED not in said:
                line = process.stdout.readline()
                assert line, said
                said += line
        assert children
        if how == "closed":
            windows.close(window)
        else:
            process.send_signal(signal.SIGINT)
        rest, _ = process.communicate(timeout=60)
        assert process.returncode == 0, said + rest
        told = (said + rest).decode()
        assert ("closed before the run ended" in told) == ((how, speed) == ("closed", "real"))
        assert "Traceback" not in told
        assert "WARN" not in told
    _, alive = psutil.wait_procs(children, timeout=5)
    assert not alive
    assert "Rerun" not in windows.named


def test_what_is_played_and_browsed_is_shown_in_a_window(results, screen, tmp_path):
    folder = ["--results", str(results.folder)]
    for words in (["play", RUN, "--seconds", "2", *folder], ["browse", RUN, *folder]):
        with showing(screen, tmp_path, *words) as (process, window, windows, children):
            windows.close(window)
            said, _ = process.communicate(timeout=60)
            assert process.returncode == 0, said
            assert b"Traceback" not in said
        _, alive = psutil.wait_procs(children, timeout=5)
        assert not alive
