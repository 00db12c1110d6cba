"""How fast a run is shown that is watched, and so how much of it."""

from collections.abc import Iterator
from math import inf, isfinite
from typing import NamedTuple

import numpy as np

from upswing.recordings.live import Plan
from upswing.runs.recording.frames import stretch_length
from upswing.study.errors import BadInput
from upswing.study.task import Task

REAL, FAST = 1.0, inf
"""Speeds: as it happens, and as fast as it goes."""

BETWEEN = 0.04
"""Time from one piece of a run to the next [s]."""

PIECES = 100
"""Number of pieces of a run that goes as fast as it can."""

LEAST_AT_ONCE = 4_000
"""Length of a piece where nobody looks: few large pieces take less room than many small ones [steps]."""

LOOKED_EVERY, GROWTH = 1.0, 0.01
"""What is known is looked at after so long [s], once the run has grown by this share."""


class Pace(NamedTuple):
    """How fast a run is shown, and how much of it."""

    speed: float  # in multiples of real time; infinite: as fast as it goes
    size: int  # of a piece [steps]
    time_step: float  # of the run [s]
    waits: bool = True  # whether somebody looks, for whom a step comes when it is due

    @classmethod
    def of(cls, speed: float, task: Task, waits: bool = True) -> "Pace":
        """For a run of a task."""
        dt = task.pendulum.time_step
        if speed == FAST:
            return cls(speed, max(stretch_length(dt), -(-task.steps // PIECES)), dt, waits)
        return cls(speed, max(1, round(speed * BETWEEN / dt)), dt, waits)

    def plan(self, steps: int) -> Plan:
        """Every step is shown, or of longer pieces the last ones."""
        left = np.minimum(self.size, steps) - 1 - np.arange(steps) % self.size
        stretch = stretch_length(self.time_step)
        if self.size <= stretch:
            return Plan.of(left >= 0, "every step", self.time_step)
        name = f"the last {stretch:,} of every {self.size:,} steps"
        return Plan.of(left < stretch, name, self.time_step)

    def pieces(self, steps: int) -> Iterator[tuple[int, int]]:
        """What is learned and drawn at once: its first step, and the step after its last."""
        size = self.size if self.waits else self.size * -(-LEAST_AT_ONCE // self.size)
        for first in range(0, steps, size):
            yield first, min(first + size, steps)

    def due(self, step: int) -> float:
        """When a step is to be seen [s after the beginning]."""
        return step * self.time_step / self.speed if self.waits else 0.0

    def next_look(self, step: int) -> float:
        """When to look at what is known after looking before ``step`` [step]."""
        if self.speed == FAST:
            return step + 1
        return step + max(LOOKED_EVERY * self.speed / self.time_step, GROWTH * step)


def parse_speed(text: str) -> float:
    """A speed, from ``real``, ``fast`` or a number of times real time.

    Raises:
        BadInput: it is none of these.
    """
    named = {"real": REAL, "fast": FAST}
    try:
        speed = named[text] if text in named else float(text)
    except ValueError:
        speed = 0.0
    if speed <= 0 or not (isfinite(speed) or text == "fast"):
        right = "must be real, fast, or a number of times real time: 10"
        raise BadInput([f"--speed: {text}: {right}"])
    return speed
