"""The rows of a recording: which stretches of a run it shows, and on which timelines."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from upswing.physics.environment import Trajectory
from upswing.study.measured import Windows

FRAME, STEP, SIM_TIME = "frame", "step", "sim_time"
TIMELINES = (FRAME, STEP, SIM_TIME)

STRETCH = 450
"""Lengths shown of the beginning, the first success, the worst stretch and the end [steps]."""

BEFORE_SUCCESS = 150
"""Distance of the beginning of its stretch from the first success [steps]."""

DRAWN_EVERY = 4
"""The pendulum is drawn 50 times a second [steps]."""

Real = NDArray[np.float64]
Steps = NDArray[np.int64]


class Frames(NamedTuple):
    """The rows of a recording: steps in stretches, each followed by one row of a gap."""

    steps: Steps  # (rows,)
    gap: NDArray[np.bool_]  # rows that only end a line: (rows,)
    time_step: float  # [s]

    @property
    def drawn(self) -> Steps:
        """The steps at which pictures are drawn."""
        return self.steps[~self.gap][::DRAWN_EVERY]

    def at(self, steps: Steps) -> Steps:
        """The first frame at or after each of ``steps``; the last frame if there is none."""
        return np.minimum(np.searchsorted(self.steps, steps), len(self.steps) - 1)


def stretches(
    trajectory: Trajectory, windows: Windows, first_stable_step: int | None, time_step: float
) -> Frames:
    """The stretches shown in full: the beginning, the first success, the worst window, the end."""
    steps = len(trajectory.angle)
    worst = np.lexsort((windows.mean_reward, -windows.falls))[0]
    begins = [0, int(windows.first_step[worst]), steps - STRETCH]
    if first_stable_step is not None:
        begins.append(first_stable_step - BEFORE_SUCCESS)
    shown = np.zeros(steps + 1, dtype=np.bool_)
    for begin in begins:
        shown[max(0, begin) : max(0, begin) + STRETCH] = True
    shown[steps] = False
    ends = np.flatnonzero(shown[:-1] & ~shown[1:]) + 1
    rows = np.sort(np.concatenate([np.flatnonzero(shown), ends]))
    # A gap's row stands at the first step that is not shown.
    return Frames(rows, ~shown[rows], time_step)


def time_columns(
    steps: Steps, frames: Frames, timelines: Iterable[str] = TIMELINES
) -> list[rr.TimeColumn]:
    """The same rows on every timeline; ``frame`` counts what is shown, without its gaps."""
    columns = {
        FRAME: lambda: rr.TimeColumn(FRAME, sequence=frames.at(steps)),
        STEP: lambda: rr.TimeColumn(STEP, sequence=steps),
        SIM_TIME: lambda: rr.TimeColumn(SIM_TIME, duration=steps * frames.time_step),
    }
    return [columns[name]() for name in timelines]


def rounded(values: NDArray[Any]) -> Real:
    """Values to 11 binary digits, a relative error below 0.05 %: they compress better."""
    mantissa, exponent = np.frexp(values.astype(np.float64))
    return np.ldexp(np.round(mantissa * 2048) / 2048, exponent)
