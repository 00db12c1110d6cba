"""The rows of a recording: which stretches of a run it shows, and on which timelines."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from upswing.physics.environment import Trajectory
from upswing.study.measured import Windows
from upswing.study.physical import THESIS_TIME_STEP

FRAME, STEP, SIM_TIME = "frame", "step", "sim_time"
TIMELINES = (FRAME, STEP, SIM_TIME)

STRETCH = 450
"""Lengths shown of the beginning, the first success, the worst stretch and the end [steps of 5 ms]."""

LONGEST_STRETCH = 10 * STRETCH
"""A stretch of many short steps ends here, or its recording would be too large [steps]."""

BEFORE_SUCCESS = 3
"""The stretch of the first success begins before it, by one of so many parts of its length."""

DRAWN_EVERY = 4
"""The pendulum is drawn 50 times a second, or at every step where steps are longer [steps of 5 ms]."""

LARGEST_TURN = 60.0
"""In a step: a larger one is a jump of the angle [°]. In longer steps the pendulum turns further."""

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
    time_step: float  # of the run [s]
    named: tuple[Stretch, ...] = ()  # in the order of their steps; none overlaps another

    @property
    def drawn(self) -> Steps:
        """The steps at which pictures are drawn."""
        return self.steps[~self.gap][:: drawn_every(self.time_step)]

    def at(self, steps: Steps) -> Steps:
        """The first frame at or after each of ``steps``; the last frame if there is none."""
        return np.minimum(np.searchsorted(self.steps, steps), len(self.steps) - 1)


def so_long(steps: int, time_step: float) -> int:
    """So many steps of the thesis, 5 ms each, in steps of ``time_step`` [s]: the same time."""
    return max(1, round(steps * THESIS_TIME_STEP / time_step))


def drawn_every(time_step: float) -> int:
    """Number of steps of ``time_step`` [s] from one picture of the pendulum to the next."""
    return so_long(DRAWN_EVERY, time_step)


def stretch_length(time_step: float) -> int:
    """Length of a stretch in steps of ``time_step`` [s]."""
    return min(so_long(STRETCH, time_step), LONGEST_STRETCH)


def real_time(time_step: float) -> float:
    """Number of frames a second at which steps of ``time_step`` [s] pass as fast as they happened."""
    return 1 / time_step


def stretches(
    trajectory: Trajectory, windows: Windows, first_stable_step: int | None, time_step: float
) -> Frames:
    """The stretches shown in full: the beginning, the first success, the worst window, the end.

    Where two overlap, the one that begins later takes over. ``time_step`` is that of the run [s].
    """
    steps, length = len(trajectory.angle), stretch_length(time_step)
    worst = np.lexsort((windows.mean_reward, -windows.falls))[0]
    begins = {BEGINNING: 0, WORST: int(windows.first_step[worst]), END: steps - length}
    if first_stable_step is not None:
        begins[FIRST_STABLE] = first_stable_step - length // BEFORE_SUCCESS
    shown = np.zeros(steps + 1, dtype=np.bool_)
    names: dict[int, list[str]] = {}
    for name, begin in begins.items():
        shown[max(0, begin) : max(0, begin) + length] = True
        names.setdefault(max(0, begin), []).append(name)
    shown[steps] = False
    ends = np.flatnonzero(shown[:-1] & ~shown[1:]) + 1
    rows = np.sort(np.concatenate([np.flatnonzero(shown), ends]))
    firsts = sorted(names)
    named = tuple(
        Stretch(first, min(first + length, following, steps), " and ".join(names[first]))
        for first, following in zip(firsts, [*firsts[1:], steps], strict=True)
    )
    # A gap's row stands at the first step that is not shown.
    return Frames(rows, ~shown[rows], time_step, named)


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


def jumps(angle: NDArray[Any], time_step: float) -> NDArray[np.bool_]:
    """Where an angle [°] that is known every ``time_step`` [s] came round or was reset."""
    largest = LARGEST_TURN * max(1.0, time_step / THESIS_TIME_STEP)
    return np.asarray(np.abs(np.diff(angle, prepend=angle[:1])) > min(largest, 180.0))


def rounded(values: NDArray[Any]) -> Real:
    """Values to 11 binary digits, a relative error below 0.05 %: they compress better."""
    mantissa, exponent = np.frexp(values.astype(np.float64))
    return np.ldexp(np.round(mantissa * 2048) / 2048, exponent)
