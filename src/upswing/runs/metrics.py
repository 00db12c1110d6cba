"""A trajectory → numbers, from every step of it, and not knowing how the run was made.

The *last fifth* is the last 20 % of the steps; *upright* is |φ| ≤ 20°, *above the horizontal*
|φ| ≤ 90°. A *fall* is a step from above the horizontal to below it: when balancing, a reset.
"""

from math import copysign, floor, nan, pi, radians
from typing import Any

import numpy as np

from upswing.physics.braking import Stoppable
from upswing.physics.environment import NEVER, Trajectory
from upswing.physics.jit import compiled
from upswing.physics.tasks import HORIZONTAL
from upswing.runs.success import SUCCESS
from upswing.study.measured import Measures, Windows
from upswing.study.physical import THESIS_TIME_STEP

UPRIGHT = radians(20)
"""Half the width of *upright* [rad]."""

STABLE_STEPS = 5_000
"""A window this long without a fall, or mostly upright (full control), is stable [steps of 5 ms]."""

END = 100_000
"""The last steps, in which a run *stands at the end* or does not: 8 min 20 s, so that a run that rises
late can reach it; or its last fifth, if that is shorter [steps of 5 ms]."""

WINDOWS = 1_000
"""Into how many windows a run is divided, at most."""

WHOLE = ("falls", "swing_ups", "too_fast", "excursions", "recovered")
"""What is counted in a window."""

NOTHING_LEARNED = copysign(nan, -1.0)
"""A mean over no steps: the NaN that x86 makes of 0/0. A run's digest holds it, so it is fixed to the
bit and the same on every processor."""


def measure(
    trajectory: Trajectory, by_falls: bool, too_fast: Stoppable, time_step: float = THESIS_TIME_STEP
) -> Measures:
    """What a run came to.

    Args:
        trajectory: the run.
        by_falls: whether a stretch without a fall is stable, or one that is mostly upright.
        too_fast: the speeds at the horizontal above which nothing stops the pendulum [rad/s].
        time_step: of the run [s]; where a length is said in steps of 5 ms, the same time is meant.
    """

    def so_long(steps: int) -> int:
        return max(1, round(steps * THESIS_TIME_STEP / time_step))

    steps = len(trajectory.angle)
    last = last_fifth(steps)
    falls, upright, above, reward = _sums(trajectory, last, steps)
    first_stable = _first_stable(trajectory, by_falls, so_long(STABLE_STEPS), SUCCESS)
    end = max(last, steps - so_long(END))
    early, half = min(so_long(5_000), steps), min(so_long(2_500), steps)
    length = steps - last
    below, recovered = _recoveries(trajectory, last, steps)
    swing_ups, speed, unstoppable = _arrivals(trajectory, 0, steps, too_fast)
    return Measures(
        steps=steps,
        falls=int(_sums(trajectory, 0, steps)[0]),
        falls_last_fifth=int(falls),
        upright_share=float(upright / length),
        above_horizontal_share=float(above / length),
        mean_reward=float(reward / length),
        first_stable_step=None if first_stable < 0 else first_stable,
        falls_first_5000=int(_sums(trajectory, 0, early)[0]),
        falls_2500_to_5000=int(_sums(trajectory, half, early)[0]),
        falls_after_stable=None
        if first_stable < 0
        else int(_sums(trajectory, first_stable, steps)[0]),
        swing_ups=swing_ups,
        swing_ups_last_fifth=_arrivals(trajectory, last, steps, too_fast)[0],
        arrival_speed=float(speed / swing_ups) if swing_ups else None,
        too_fast_share=float(unstoppable / swing_ups) if swing_ups else None,
        recovered_share=recovered / below if below else None,
        upright_at_end=float(_sums(trajectory, end, steps)[1] / (steps - end)),
        too_fast_last_fifth=int(_arrivals(trajectory, last, steps, too_fast)[2]),
        diverged_at=None if (at := int(trajectory.diverged_at[0])) == NEVER else at,
    )


def last_fifth(steps: int) -> int:
    """The first step of the last fifth."""
    return steps - max(steps // 5, 1)


def in_windows(trajectory: Trajectory, too_fast: Stoppable) -> Windows:
    """The run in at most ``WINDOWS`` windows; ``too_fast`` as for ``measure``."""
    steps = len(trajectory.angle)
    length = -(-steps // WINDOWS)
    count = -(-steps // length)
    first_step = np.arange(count, dtype=np.int64) * length
    columns: dict[str, Any] = {
        name: np.zeros(count, dtype=np.int64 if name in WHOLE else np.float64)
        for name in Windows._fields
    }
    columns["first_step"] = first_step
    columns["steps"] = np.minimum(first_step + length, steps) - first_step
    windows = Windows(**columns)
    _fill(trajectory, windows)
    _count(trajectory, windows, too_fast)
    return windows


@compiled
def physical(angle: float) -> float:
    """φ [rad] within one turn, however often the pendulum went round."""
    return angle - 2 * pi * floor((angle + pi) / (2 * pi))


@compiled
def falls_at(trajectory: Trajectory, t: int) -> bool:
    """Whether step ``t`` leads from above the horizontal to below it."""
    if trajectory.reset[t]:
        return True
    if t + 1 >= len(trajectory.angle):
        return False
    here, there = physical(trajectory.angle[t]), physical(trajectory.angle[t + 1])
    return abs(here) <= HORIZONTAL < abs(there)


@compiled
def _sums(trajectory: Trajectory, first: int, last: int) -> tuple[int, int, int, float]:
    """Falls, steps upright, steps above the horizontal and rewards from ``first`` up to ``last``."""
    falls, upright, above, reward = 0, 0, 0, 0.0
    for t in range(first, last):
        tilt = abs(physical(trajectory.angle[t]))
        falls += falls_at(trajectory, t)
        upright += tilt <= UPRIGHT
        above += tilt <= HORIZONTAL
        reward += trajectory.reward[t]
    return falls, upright, above, reward


@compiled
def _arrivals(
    trajectory: Trajectory, first: int, last: int, too_fast: Stoppable
) -> tuple[int, float, int]:
    """Arrivals above the horizontal from below, their speeds in sum, and how many are too fast.

    The speed is that at the horizontal itself, between the last step below and the first above.
    """
    arrivals, speeds, unstoppable = 0, 0.0, 0
    for t in range(first, last - 1):
        below = abs(physical(trajectory.angle[t]))
        above = abs(physical(trajectory.angle[t + 1]))
        if above <= HORIZONTAL < below and not trajectory.reset[t]:
            before, after = trajectory.angular_velocity[t], trajectory.angular_velocity[t + 1]
            share = (below - HORIZONTAL) / (below - above)
            arriving = before + share * (after - before)
            speed = abs(arriving)
            arrivals += 1
            speeds += speed
            unstoppable += speed > (too_fast.rising if arriving > 0 else too_fast.falling)
    return arrivals, speeds, unstoppable


@compiled
def _recoveries(trajectory: Trajectory, first: int, last: int) -> tuple[int, int]:
    """Excursions below the horizontal, and those that end upright before the next one begins."""
    excursions, recovered = 0, 0
    is_below, is_open = False, False
    for t in range(first, last):
        tilt = abs(physical(trajectory.angle[t]))
        if tilt > HORIZONTAL and not is_below:
            excursions += 1
            is_open = True
        is_below = tilt > HORIZONTAL
        if is_open and tilt <= UPRIGHT:
            recovered += 1
            is_open = False
    return excursions, recovered


@compiled
def _fill(trajectory: Trajectory, windows: Windows) -> None:
    for w in range(len(windows.first_step)):
        first = windows.first_step[w]
        last = first + windows.steps[w]
        falls, upright, above, reward = _sums(trajectory, first, last)
        windows.falls[w] = falls
        windows.upright_share[w] = upright / windows.steps[w]
        windows.above_horizontal_share[w] = above / windows.steps[w]
        windows.mean_reward[w] = reward / windows.steps[w]
        lowest = highest = trajectory.angle[first]
        speed, td_errors, learned = 0.0, 0.0, 0
        for t in range(first, last):
            lowest = min(lowest, trajectory.angle[t])
            highest = max(highest, trajectory.angle[t])
            speed = max(speed, abs(trajectory.angular_velocity[t]))
            if trajectory.td_error[t] == trajectory.td_error[t]:  # not NaN
                td_errors += abs(trajectory.td_error[t])
                learned += 1
        windows.lowest_angle[w] = lowest
        windows.highest_angle[w] = highest
        windows.highest_speed[w] = speed
        windows.mean_td_error[w] = td_errors / learned if learned > 0 else NOTHING_LEARNED


@compiled
def _count(trajectory: Trajectory, windows: Windows, too_fast: Stoppable) -> None:
    """Arrivals and excursions by window: each counts in the window in which it begins."""
    began = 0
    is_below, is_open = False, False
    for w in range(len(windows.first_step)):
        first = windows.first_step[w]
        last = first + windows.steps[w]
        arrivals, _, unstoppable = _arrivals(
            trajectory, first, min(last + 1, len(trajectory.angle)), too_fast
        )
        windows.swing_ups[w], windows.too_fast[w] = arrivals, unstoppable
        for t in range(first, last):
            tilt = abs(physical(trajectory.angle[t]))
            if tilt > HORIZONTAL and not is_below:
                began = w
                windows.excursions[w] += 1
                is_open = True
            is_below = tilt > HORIZONTAL
            if is_open and tilt <= UPRIGHT:
                windows.recovered[began] += 1
                is_open = False


@compiled
def _first_stable(trajectory: Trajectory, by_falls: bool, length: int, share: float) -> int:
    """The first start of a stable window of ``length`` steps; −1 if there is none."""
    good = 0  # of the window's steps: those without a fall, or those upright
    needed = length if by_falls else share * length
    for t in range(len(trajectory.angle)):
        good += _is_good(trajectory, by_falls, t)
        if t >= length:
            good -= _is_good(trajectory, by_falls, t - length)
        if t >= length - 1 and good >= needed:
            return t - length + 1
    return -1


@compiled
def _is_good(trajectory: Trajectory, by_falls: bool, t: int) -> bool:
    if by_falls:
        return not falls_at(trajectory, t)
    return abs(physical(trajectory.angle[t])) <= UPRIGHT
