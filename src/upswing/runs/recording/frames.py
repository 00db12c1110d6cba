"""The rows of a recording: which stretches of a run it shows, and on which timelines."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from upswing.physics.environment import Trajectory
from upswing.physics.pendulum import Pendulum
from upswing.study.measured import Windows

FRAME, STEP, SIM_TIME = "frame", "step", "sim_time"
TIMELINES = (FRAME, STEP, SIM_TIME)

STRETCH = 450
"""Lengths shown of the beginning, the first success, the worst stretch and the end [steps]."""

BEFORE_SUCCESS = 150
"""Distance of the beginning of its stretch from the first success [steps]."""

DRAWN_EVERY = 4
"""The pendulum is drawn 50 times a second [steps]."""

REAL_TIME = 1 / Pendulum().time_step
"""Number of frames a second at which what is shown passes as fast as it happened: one for each step."""

BEGINNING, WORST, FIRST_STABLE, END = "beginning", "worst", "first stable", "end"
"""What the stretches are called."""

Real = NDArray[np.float64]
Steps = NDArray[np.int64]


class Stretch(NamedTuple):
    """A part of a run that is shown step by step, and why."""

    first: int  # its first step
    after: int  # the step after its last
    name: str


class Frames(NamedTuple):
    """The rows of a recording: steps in stretches, each followed by one row of a gap."""

    steps: Steps  # (rows,)
    gap: NDArray[np.bool_]  # rows that only end a line: (rows,)
    named: tuple[Stretch, ...] = ()  # in the order of their steps; none overlaps another

    @property
    def drawn(self) -> Steps:
        """The steps at which pictures are drawn."""
        return self.steps[~self.gap][::DRAWN_EVERY]

    def at(self, steps: Steps) -> Steps:
        """The first frame at or after each of ``steps``; the last frame if there is none."""
        return np.minimum(np.searchsorted(self.steps, steps), len(self.steps) - 1)


def stretches(trajectory: Trajectory, windows: Windows, first_stable_step: int | None) -> Frames:
    """The stretches shown in full: the beginning, the first success, the worst window, the end.

    Where two overlap, the one that begins later takes over.
    """
    steps = len(trajectory.angle)
    worst = np.lexsort((windows.mean_reward, -windows.falls))[0]
    begins = {BEGINNING: 0, WORST: int(windows.first_step[worst]), END: steps - STRETCH}
    if first_stable_step is not None:
        begins[FIRST_STABLE] = first_stable_step - BEFORE_SUCCESS
    shown = np.zeros(steps + 1, dtype=np.bool_)
    names: dict[int, list[str]] = {}
    for name, begin in begins.items():
        shown[max(0, begin) : max(0, begin) + STRETCH] = True
        names.setdefault(max(0, begin), []).append(name)
    shown[steps] = False
    ends = np.flatnonzero(shown[:-1] & ~shown[1:]) + 1
    rows = np.sort(np.concatenate([np.flatnonzero(shown), ends]))
    firsts = sorted(names)
    named = tuple(
        Stretch(first, min(first + STRETCH, following, steps), " and ".join(names[first]))
        for first, following in zip(firsts, [*firsts[1:], steps], strict=True)
    )
    # A gap's row stands at the first step that is not shown.
    return Frames(rows, ~shown[rows], named)


def time_columns(
    steps: Steps, frames: Frames, timelines: Iterable[str] = TIMELINES
) -> list[rr.TimeColumn]:
    """The same rows on every timeline; ``frame`` counts what is shown, without its gaps."""
    columns = {
        FRAME: lambda: rr.TimeColumn(FRAME, sequence=frames.at(steps)),
        STEP: lambda: rr.TimeColumn(STEP, sequence=steps),
        SIM_TIME: lambda: rr.TimeColumn(SIM_TIME, duration=steps * Pendulum().time_step),
    }
    return [columns[name]() for name in timelines]


def rounded(values: NDArray[Any]) -> Real:
    """Values to 11 binary digits, a relative error below 0.05 %: they compress better."""
    mantissa, exponent = np.frexp(values.astype(np.float64))
    return np.ldexp(np.round(mantissa * 2048) / 2048, exponent)
