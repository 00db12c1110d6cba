"""What happens in a run: falls, arrivals, getting up; of every stretch, and the first and last of all.

A run of a million steps may fall ten thousand times. So it is looked at step by step only in the
stretches that a recording shows, and in the windows where something happens first or last.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.physics.environment import Trajectory
from upswing.physics.tasks import HORIZONTAL
from upswing.runs.metrics import UPRIGHT
from upswing.runs.recording.frames import Frames
from upswing.study.measured import Measures, Windows

FIRST_FALLS = 50
"""Number of first resets of a run that are named wherever they happen."""

Counts = NDArray[np.int64]


class Event(NamedTuple):
    """Something that happened."""

    step: int
    level: str  # as in a log: INFO, WARN, ERROR
    text: str


class Passages(NamedTuple):
    """Where a part of a run passes the horizontal or comes upright: steps, each of shape (events,)."""

    falls: Counts  # lead from above the horizontal to below it, or to a reset
    arrivals: Counts  # lead from below the horizontal to above it
    speeds: NDArray[np.float64]  # |φ̇| at the horizontal on arriving [rad/s]: (arrivals,)
    risen: Counts  # the first upright step since the pendulum was below the horizontal


def passages(trajectory: Trajectory, first: int, after: int) -> Passages:
    """What happens from step ``first`` up to ``after``; it is counted as the measures count it."""
    angle = trajectory.angle[first : after + 1].astype(np.float64)
    tilt = np.abs(angle - 2 * np.pi * np.floor((angle + np.pi) / (2 * np.pi)))
    reset = trajectory.reset[first : first + len(angle) - 1]
    here, there = tilt[:-1], tilt[1:]
    fell = reset | ((here <= HORIZONTAL) & (there > HORIZONTAL))
    arrived = (here > HORIZONTAL) & (there <= HORIZONTAL) & ~reset
    if after >= len(trajectory.angle):  # the last step of a run may be a reset, and nothing else
        fell = np.append(fell, trajectory.reset[-1])
        arrived = np.append(arrived, False)
    at = np.flatnonzero(arrived)
    share = (here[at] - HORIZONTAL) / (here[at] - there[at])
    before, following = (trajectory.angular_velocity[first + at + i].astype(float) for i in (0, 1))
    steps = np.arange(len(tilt))
    last_below = np.maximum.accumulate(np.where(tilt > HORIZONTAL, steps, -1))
    last_upright = np.maximum.accumulate(np.where(tilt <= UPRIGHT, steps, -1))
    # Upright now, and since the step before it was last upright it has been below the horizontal.
    risen = (last_upright == steps)[1:] & (last_below[1:] > last_upright[:-1])
    return Passages(
        falls=first + np.flatnonzero(fell),
        arrivals=first + at,
        speeds=np.abs(before + share * (following - before)),
        risen=first + 1 + np.flatnonzero(risen[: after - first - 1]),
    )


def last_fall(trajectory: Trajectory, windows: Windows) -> int | None:
    """The step of a run's last fall; None if it never fell."""
    some = np.flatnonzero(windows.falls)
    if not len(some):
        return None
    first = int(windows.first_step[some[-1]])
    return int(passages(trajectory, first, first + int(windows.steps[some[-1]])).falls[-1])


def happenings(
    trajectory: Trajectory, windows: Windows, measures: Measures, frames: Frames
) -> list[Event]:
    """The events of a run, in the order of their steps."""
    falls: dict[int, int] = {}  # the number of each fall that is named, by its step
    arrivals: dict[int, tuple[int, float]] = {}  # number and speed [rad/s] likewise
    risen: list[int] = []
    events = [Event(0, "INFO", "start"), Event(measures.steps - 1, "INFO", "end of the run")]
    for number, stretch in enumerate(frames.named, 1):
        words = f"▶ stretch {number} of {len(frames.named)}: {stretch.name}"
        events.append(Event(stretch.first, "INFO", words))
    for first, after, falls_before, arrivals_before in _looked_at(windows, frames):
        found = passages(trajectory, first, after)
        falls |= {int(t): falls_before + i for i, t in enumerate(found.falls, 1)}
        arrivals |= {
            int(t): (arrivals_before + i, float(speed))
            for i, (t, speed) in enumerate(zip(found.arrivals, found.speeds, strict=True), 1)
        }
        risen += found.risen.tolist()
    resets = np.flatnonzero(trajectory.reset)[:FIRST_FALLS]
    falls |= {int(t): i for i, t in enumerate(resets, 1)}
    shown = {*frames.steps[~frames.gap].tolist(), *resets.tolist()}
    events += [
        Event(step, "WARN", f"fall {number:,} of {measures.falls:,}{_after(trajectory, step)}")
        for step, number in falls.items()
        if step in shown or number in (1, measures.falls)
    ]
    events += [
        Event(step, "INFO", f"arrival {number:,} of {measures.swing_ups:,} at {speed:.1f} rad/s")
        for step, (number, speed) in arrivals.items()
        if step in shown or number in (1, measures.swing_ups)
    ]
    events += [
        Event(step, "INFO", "upright, after it was below the horizontal")
        for step in risen
        if step in shown
    ]
    if measures.first_stable_step is not None:
        events.append(Event(measures.first_stable_step, "INFO", "the first stable window begins"))
    if measures.diverged_at is not None:
        words = "diverged: a value is not finite, and nothing after it means anything"
        events.append(Event(measures.diverged_at, "ERROR", words))
    return sorted(events, key=lambda event: event.step)


def _after(trajectory: Trajectory, step: int) -> str:
    return ": reset to a new start" if trajectory.reset[step] else ""


def _looked_at(windows: Windows, frames: Frames) -> Iterator[tuple[int, int, int, int]]:
    """Parts of the run to look at: first step, the step after, falls and arrivals before it.

    Whole windows, for the numbers of falls and arrivals are known where a window begins.
    """
    ends = windows.first_step + windows.steps
    chosen = np.zeros(len(ends), dtype=np.bool_)
    for stretch in frames.named:
        chosen |= (windows.first_step < stretch.after) & (ends > stretch.first)
    for counts in (windows.falls, windows.swing_ups):
        some = np.flatnonzero(counts)
        chosen[some[:1]] = chosen[some[-1:]] = True
    before = [np.cumsum(counts) - counts for counts in (windows.falls, windows.swing_ups)]
    borders = np.flatnonzero(np.diff(chosen, prepend=False, append=False))
    for begin, after in borders.reshape(-1, 2):  # windows side by side are one part
        falls, arrivals = (int(counts[begin]) for counts in before)
        yield int(windows.first_step[begin]), int(ends[after - 1]), falls, arrivals
