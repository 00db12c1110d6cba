"""What a figure shows, in sentences made of the results: nothing here knows how they came out."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from upswing.analysis.colours import name_of
from upswing.analysis.survival import median_time
from upswing.figures.decided import Decided
from upswing.figures.lengths import in_steps
from upswing.figures.success_share import share
from upswing.runs.results import Results

TIMES: dict[float, str] = {0: "not once", 1: "once", 2: "twice"}


def middle(results: Results, cell: str, measure: str) -> float:
    """The median of a measure over the runs of a cell that count; NaN of none."""
    values = results.counted(cell)[measure].to_numpy(float)
    return float(np.median(values)) if len(values) else float("nan")


def number(value: float) -> str:
    """A number as a sentence has it."""
    if np.isnan(value):
        return "an unknown number of"
    return f"{value:,.0f}" if float(value).is_integer() or abs(value) >= 100 else f"{value:,.1f}"


def times(value: float) -> str:
    """How often something happens: not once, once, twice, 5 times."""
    return TIMES.get(value, f"{number(value)} times")


def per_cent(value: float) -> str:
    """A share, as a sentence has it."""
    return f"{number(round(100 * value, 1))} %"


def counted(results: Results, cell: str) -> str:
    """How many runs of a cell succeed: ``129 of 200``."""
    found = share(results, cell)
    return f"{found.successes} of {found.of}"


def one_by_one(results: Results, cells: Mapping[str, str]) -> str:
    """How many runs of each cell succeed: ``7 of 200 with α = 0.75``, and so on."""
    return ", ".join(f"{counted(results, cell)} with {label}" for cell, label in cells.items())


def stood(results: Results, cell: str) -> str:
    """How many runs of full control were ever stable, from when on, and in the median."""
    from upswing.runs.metrics import STABLE_STEPS

    runs = results.counted(cell)
    known = runs["first_stable_step"].dropna()
    stretch = in_steps(STABLE_STEPS, [results.task(cell)])
    if not len(known):
        return f"none was ever upright for 90 % of {stretch} in a row"
    words = f"{len(known)} of {len(runs)} have been upright for 90 % of {stretch} in a row, "
    words += f"the first of them from step {int(known.min()):,} on"
    if 2 * len(known) < len(runs):  # then half of them never were, and there is no median
        return words
    when = [None if pd.isna(time) else float(time) for time in runs["first_stable_step"]]
    half, *_ = median_time(when, float(results.task(cell).steps))
    return words + (f" (Kaplan–Meier median: step {half:,.0f})" if np.isfinite(half) else "")


def of_a_part(part: Decided | None) -> str:
    """How many of how many an estimate of a share comes to: ``102 of 166``."""
    if part is None or not part.evidence[0].n:
        return ""
    row = part.evidence[0]
    return f"{round(row.estimate * row.n)} of {row.n}"


def over_alpha(results: Results, task: str, architecture: str, cells: Mapping[float, str]) -> str:
    """From the worst to the best step size of an architecture, and which are the best."""
    architecture = name_of(architecture)
    shares = {alpha: share(results, cell).value / 100 for alpha, cell in sorted(cells.items())}
    found = {alpha: value for alpha, value in shares.items() if not np.isnan(value)}
    if not found:
        return f"of {architecture} ({task}) every run diverged"
    low, high = min(found.values()), max(found.values())
    if low == high:
        return f"of {architecture} ({task}) {per_cent(low)} of runs succeed whatever α"
    best = " and ".join(f"{alpha:g}" for alpha, value in found.items() if value == high)
    return (
        f"of {architecture} ({task}) {per_cent(low)} to {per_cent(high)} of runs succeed, most with "
        f"α = {best}"
    )
