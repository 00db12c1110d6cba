"""What is measured of a run, by name: light, so that claims are checked without what computes it."""

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Real = NDArray[np.float64]
    Count = NDArray[np.int64]


class Measures(NamedTuple):
    """What is measured of a run; shares and means over its last fifth."""

    steps: int
    falls: int
    falls_last_fifth: int
    upright_share: float
    above_horizontal_share: float
    mean_reward: float  # [rad²]
    first_stable_step: int | None  # the start of the first stable window; None if there is none
    falls_first_5000: int  # in the first 5,000 steps
    falls_2500_to_5000: int  # from step 2,500 up to step 5,000
    falls_after_stable: int | None  # from the first stable step on; None if there is none
    swing_ups: int  # arrivals above the horizontal from below
    swing_ups_last_fifth: int
    arrival_speed: float | None  # mean |φ̇| on arriving [rad/s]; None without arrivals
    too_fast_share: float | None  # share of arrivals that ±10 m/s² cannot stop; None without them
    recovered_share: float | None  # see ``_recoveries``, in the last fifth; None if never below
    upright_at_end: (
        float  # share of upright steps in the last 100,000, or the last fifth if shorter
    )
    too_fast_last_fifth: int  # arrivals in the last fifth that ±10 m/s² cannot stop
    diverged_at: int | None  # the step at which a value was not finite; None if all were


class Greedy(NamedTuple):
    """What the greedy policy came to."""

    greedy_success_share: float  # of the starts: without a fall, or upright ≥ 90 % at the end
    greedy_upright_share: float  # of the judged steps (balancing: all) of all starts


MEASURES = (*Measures._fields, *Greedy._fields, "seconds", "steps_per_second")
"""The columns of the table of runs that a claim may ask for."""


class Windows(NamedTuple):
    """A run in windows of equal length (the last may be shorter); every array has shape (windows,)."""

    first_step: "Count"
    steps: "Count"
    falls: "Count"
    upright_share: "Real"
    above_horizontal_share: "Real"
    mean_reward: "Real"  # [rad²]
    lowest_angle: "Real"  # [rad]
    highest_angle: "Real"  # [rad]
    highest_speed: "Real"  # |φ̇| [rad/s]
    mean_td_error: "Real"  # |δ| [rad²], of the steps that learned; NaN if none did
    swing_ups: "Count"  # arrivals above the horizontal from below
    too_fast: "Count"  # of them those that ±10 m/s² cannot stop
    excursions: "Count"  # below the horizontal, that began in the window
    recovered: "Count"  # of them those that ended upright before the next one
