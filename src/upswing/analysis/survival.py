"""When runs got somewhere, some of them never: Kaplan and Meier's estimate, from scipy."""

import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from upswing.analysis.statistics import CONFIDENCE, Estimate, no_runs, share


def share_by(times: Sequence[float | None], limit: float, horizon: float) -> Estimate:
    """The share that got there by ``limit``: Kaplan–Meier, with a log-log interval.

    Args:
        times: when each run got there; None for a run that had not by ``horizon``, and is censored.
        limit: the time asked about.
        horizon: how long every run was watched.
    """
    n = len(times)
    if not n:
        return no_runs()
    reached = sum(time is not None and time <= limit for time in times)
    if reached in (0, n):  # the log-log interval has no width there; Wilson's has
        return share(reached, n)._replace(method="Kaplan–Meier (Wilson at 0 and 1)")
    survival, interval = _survival(times, horizon)
    value, low, high = (
        1 - float(curve.evaluate(limit)) for curve in (survival, interval.high, interval.low)
    )
    return Estimate(value, low, high, n, "Kaplan–Meier, log-log")


def median_time(times: Sequence[float | None], horizon: float) -> tuple[float, float, float]:
    """The median time and its interval by Kaplan–Meier; infinite where half never got there."""
    if not any(time is not None for time in times):
        return np.inf, np.inf, np.inf
    survival, interval = _survival(times, horizon)

    def halved(curve: Any) -> float:
        below = np.flatnonzero(np.asarray(curve.probabilities) <= 0.5)
        return float(curve.quantiles[below[0]]) if len(below) else np.inf

    return halved(survival), halved(interval.low), halved(interval.high)


def _survival(times: Sequence[float | None], horizon: float) -> tuple[Any, Any]:
    """Scipy's survival function of times that are censored at ``horizon``, and its interval."""
    from scipy import stats  # the slowest import of all, for what few claims ask

    data = stats.CensoredData(
        uncensored=[time for time in times if time is not None],
        right=[horizon for time in times if time is None],
    )
    survival = stats.ecdf(data).sf
    with warnings.catch_warnings():
        # Where all have got there the interval is undefined; nothing is asked of it there.
        warnings.simplefilter("ignore", RuntimeWarning)
        return survival, survival.confidence_interval(CONFIDENCE, method="log-log")
