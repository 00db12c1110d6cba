"""What is measured of a run, as the axis of a panel."""

from collections.abc import Collection
from typing import NamedTuple

from upswing.figures.lengths import end_of
from upswing.study.claim_parts import Part
from upswing.study.physical import THESIS_TIME_STEP
from upswing.study.task import Task

PERCENT = 100.0

WORDS = {
    "falls": "falls",
    "falls_last_fifth": "falls in the last fifth",
    "falls_first_5000": "falls in the first 5,000 steps",
    "falls_2500_to_5000": "falls from step 2,500 to 5,000",
    "falls_after_stable": "falls after the first 5,000 steps without one",
    "mean_reward": "mean reward of the last fifth [rad²]; the cost is minus it",
    "upright_share": "upright in the last fifth [%]",
    "upright_at_end": "upright in the last {end} [%]",
    "recovered_share": "falls that it came up from in the last fifth [%]",
    "first_stable_step": "step of the first stable window",
}
"""What an axis is called; a measure that is not here is called by its name."""

IN_STEPS = ("falls_first_5000", "falls_2500_to_5000", "falls_after_stable")
"""Measures that are about so many steps of the thesis: the same time, where a step is another."""

OF_SUMS = {
    ("too_fast_last_fifth", "swing_ups_last_fifth"): "arrivals that full braking cannot stop [%]",
}
"""Shares of two counts of the same run."""

COUNTS = ("falls", "swing_ups", "too_fast_last_fifth")
"""Measures that count begin with one of these."""


class AxisOf(NamedTuple):
    """How a measure is drawn."""

    label: str
    factor: float  # from the table's unit to that of the axis
    within: tuple[float, float] | None  # the ends of the axis, where a measure has ends
    is_count: bool  # a count is drawn on a scale that shows 0, 1 and hundreds


class Threshold(NamedTuple):
    """From where on a run is counted."""

    at: float  # in the unit of the axis; between two counts
    words: str


def axis_of(part: Part, tasks: Collection[Task] = ()) -> AxisOf:
    """The axis of what a part measures of each run, of these tasks."""
    if part.per is not None:
        pair = (str(part.measure), str(part.per))
        words = OF_SUMS.get(pair, f"{pair[0]} / {pair[1]} [%]".replace("_", " "))
        return AxisOf(words, PERCENT, (0.0, 100.0), is_count=False)
    alone = described(part.measure or next(iter(part.where), ""), tasks)
    if not part.paired:
        return alone
    words = f"difference of the same seed, {alone.label}"
    return AxisOf(words, alone.factor, None, is_count=False)


def described(name: str, tasks: Collection[Task] = ()) -> AxisOf:
    """The axis of a measure of each run, of these tasks."""
    words = WORDS.get(name, name.replace("_", " ")).format(end=end_of(tasks))
    if name in IN_STEPS and any(task.pendulum.time_step != THESIS_TIME_STEP for task in tasks):
        words += " of 5 ms"
    if name.endswith("_share") or name.startswith("upright_"):
        return AxisOf(words, PERCENT, (0.0, 100.0), is_count=False)
    return AxisOf(words, 1.0, None, is_count=name.startswith(COUNTS))


def threshold_of(part: Part) -> Threshold | None:
    """From where on a run counts as one that a part counts; None where nothing is counted."""
    if not part.where:
        return None
    bound = next(iter(part.where.values()))
    scale = axis_of(part)
    unit = " %" if scale.factor == PERCENT else ""
    if bound.at_least is not None:
        value, sign, half = bound.at_least, "≥", -0.5
    elif bound.at_most is not None:
        value, sign, half = bound.at_most, "≤", 0.5
    else:
        value, sign, half = float(bound.below or 0.0), "<", -0.5
    shown = scale.factor * float(value)
    words = "none" if scale.is_count and (sign, shown) == ("≤", 0) else f"{sign} {shown:g}{unit}"
    return Threshold(shown + half if scale.is_count else shown, f"counted: {words}")
