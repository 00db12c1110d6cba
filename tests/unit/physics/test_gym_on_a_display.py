"""``render_mode="human"`` in a window that is really opened."""

import os
import subprocess
import sys

import pytest

from tests.unit.display import Windows, display, why_not

pytest.importorskip("gymnasium")
pytest.importorskip("tkinter", reason="matplotlib draws its windows here with tkinter")
pytestmark = pytest.mark.skipif(bool(why_not()), reason=why_not())

SCRIPT = """
import sys
import gymnasium
import matplotlib.pyplot as plt
env = gymnasium.make(
    "upswing.physics.gym:upswing/FullControl-v0", render_mode="human", max_episode_steps=100_000,
    length=0.4, time_step=0.01, accelerations=[-20, -10, 0, 10, 20], track={"limit": 2.0},
)
env.reset(seed=0)
(number,) = plt.get_fignums()
print("begun", flush=True)
steps = 0
while plt.fignum_exists(number):
    env.step(steps // 7 % 5)
    steps += 1
env.step(0)
env.reset(seed=1)
env.step(4)
env.close()
print(steps, plt.get_backend(), plt.get_fignums())
"""


def test_a_window_moves_in_real_time_until_it_is_closed_and_the_episode_goes_on():
    with display() as screen:
        surroundings = {**os.environ, "DISPLAY": screen.name}
        surroundings.pop("MPLBACKEND", None)
        process = subprocess.Popen(
            [sys.executable, "-c", SCRIPT], env=surroundings,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        try:
            windows = Windows(screen.name)
            window = windows.wait_for("upswing: full-control")
            assert process.stdout.readline() == "begun\n"
            first = screen.shown()
            windows.wait_until(lambda: screen.shown() != first)  # it moves
            windows.close(window)
            said, complained = process.communicate(timeout=60)
            assert process.returncode == 0, complained
            assert complained == ""
            steps, backend, left = said.split(maxsplit=2)
            assert int(steps) > 1  # how many depends on how soon it is closed
            assert backend.lower() == "tkagg"
            assert left.strip() == "[]"
            assert "upswing: full-control" not in windows.named
        finally:
            process.kill()
            process.wait(20)
