"""Numbers over runs → estimates with intervals. The unit is one run.

From scipy where it has them. Every interval is one of 95 % for the estimate, unlike the spread, the
5th to 95th percentile of the runs themselves. Bootstraps are seeded, so that the same runs give the
same interval.
"""

from collections.abc import Callable, Sequence
from functools import cache
from itertools import combinations
from math import ceil, floor, hypot, sqrt
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import special

CONFIDENCE = 0.95
RESAMPLES = 10_000
SEED = 20_261_122
"""The bootstrap's own seed; any will do, as long as it stays."""

Real = NDArray[np.float64]
Sample = Sequence[float] | NDArray[Any]
"""One value for each run, shape (n,)."""


Tail = Callable[[float, bool], float]


class Estimate(NamedTuple):
    """An estimate, its interval, and how it was reached."""

    value: float
    low: float
    high: float
    n: int  # runs, or pairs of runs
    method: str
    p_value: Tail
    """How likely an estimate as favourable is if the truth just misses a threshold, given that and
    whether the claim is to be at least the threshold."""


def binomial_tail(value: float, n: int) -> Tail:
    """The exact binomial test of a share ``value`` of ``n``."""

    def p_value(threshold: float, at_least: bool) -> float:
        # Half a success, of a tie, is none where successes speak for the claim.
        successes = (floor if at_least else ceil)(round(value * n, 9))
        side = "greater" if at_least else "less"
        from scipy import stats  # it takes half a second, and pictures need no tests

        return float(stats.binomtest(successes, n, threshold, side).pvalue)

    return p_value


def bootstrap_tail(resampled: Real) -> Tail:
    """The part of a bootstrap distribution, shape (resamples,), on the wrong side of a threshold."""

    def p_value(threshold: float, at_least: bool) -> float:
        if not np.isfinite(resampled).all():  # 0/0, for example: then nothing speaks for the claim
            return 1.0
        wrong = resampled < threshold if at_least else resampled > threshold
        return float((1 + wrong.sum()) / (1 + len(resampled)))

    return p_value


def normal_tail(value: float, low: float, high: float) -> Tail:
    """As if the half of an interval that faces the threshold were that of a normal distribution."""

    def p_value(threshold: float, at_least: bool) -> float:
        deviation = (value - low if at_least else high - value) / _z(CONFIDENCE)
        distance = (value - threshold) if at_least else (threshold - value)
        if deviation == 0:  # the interval ends at its estimate, as at a difference of 1
            return 0.0 if distance > 0 else 1.0
        return float(special.ndtr(-distance / deviation))

    return p_value


def no_runs(low: float = 0.0, high: float = 1.0) -> Estimate:
    """What no runs tell: nothing."""
    return Estimate(np.nan, low, high, 0, "no runs", lambda _threshold, _at_least: 1.0)


def share(successes: int, n: int, confidence: float = CONFIDENCE) -> Estimate:
    """A share k of n with Wilson's interval; from 0 to 1 of no runs at all."""
    if not n:
        return no_runs()
    low, high = wilson(successes / n, n, confidence)
    value = successes / n
    tail = binomial_tail(value, n)
    return Estimate(value, low, high, n, "share, Wilson", tail)


def difference_of_shares(
    x: Sequence[bool], y: Sequence[bool], confidence: float = CONFIDENCE
) -> Estimate:
    """The share of x minus that of y, with Newcombe's interval from Wilson's of both.

    It takes the runs as if they were not paired, which makes it wider than it need be.
    """
    if not len(x) or not len(y):
        return no_runs(-1.0, 1.0)
    one, other = share(sum(x), len(x), confidence), share(sum(y), len(y), confidence)
    value = one.value - other.value
    low = value - hypot(one.value - one.low, other.high - other.value)
    high = value + hypot(one.high - one.value, other.value - other.low)
    tail = normal_tail(value, low, high)
    n = min(len(x), len(y))
    return Estimate(value, low, high, n, "difference of shares, Newcombe", tail)


def mean(values: Sample) -> Estimate:
    """The mean; bootstrap, percentiles."""
    return bootstrapped("mean", lambda x: x.mean(axis=-1), [values])


def median(values: Sample) -> Estimate:
    """The median; bootstrap, percentiles."""
    return bootstrapped("median", lambda x: _middle(x, (np.shape(x)[-1] - 1) // 2), [values])


def interquartile_mean(values: Sample) -> Estimate:
    """The mean of the middle half; bootstrap, percentiles."""
    return bootstrapped("interquartile mean", lambda x: _middle(x, np.shape(x)[-1] // 4), [values])


def _middle(values: Real, cut: int) -> Real:
    """The mean along the last axis without the ``cut`` smallest and the ``cut`` largest.

    What ``np.median`` and ``scipy.stats.trim_mean`` compute, in a tenth of the time: numpy sorts short
    rows much faster than it partitions them, as those two do.
    """
    ordered = np.sort(values, axis=-1)
    return np.asarray(ordered[..., cut : ordered.shape[-1] - cut].mean(axis=-1))


LOCATIONS: dict[str, Callable[[Sample], Estimate]] = {
    "mean": mean,
    "median": median,
    "interquartile_mean": interquartile_mean,
}


def ratio_of_means(x: Sample, y: Sample) -> Estimate:
    """mean(x) / mean(y) of paired runs; bootstrap of the pairs, percentiles."""

    def ratio(a: Real, b: Real) -> Real:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(a.mean(axis=-1) / b.mean(axis=-1))

    return bootstrapped("ratio of means, paired", ratio, [x, y])


def difference_of_means(x: Sample, y: Sample) -> Estimate:
    """mean(x) − mean(y) of paired runs; bootstrap of the pairs, percentiles."""
    return bootstrapped(
        "difference of means, paired", lambda a, b: a.mean(axis=-1) - b.mean(axis=-1), [x, y]
    )


def probability_greater(x: Sample, y: Sample) -> Estimate:
    """P(X > Y) + ½ P(X = Y) of paired runs, with Wilson's interval.

    A bootstrap would claim certainty where all pairs agree. A tie counts half, which makes Wilson's
    interval wider than it need be.
    """
    if len(x) != len(y):
        raise ValueError(f"paired samples differ in length: {len(x)}, {len(y)}")
    if not len(x):
        return no_runs()
    a, b = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    value = float(((a > b) + 0.5 * (a == b)).mean())
    low, high = wilson(value, len(a))
    tail = binomial_tail(value, len(a))
    return Estimate(value, low, high, len(a), "P(X > Y), paired, Wilson", tail)


def wilson(value: float, n: int, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Wilson's interval for a share ``value`` of ``n``, which need not be a whole number of them."""
    z = _z(confidence)
    middle = (value + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z * sqrt(value * (1 - value) / n + z**2 / (4 * n**2)) / (1 + z**2 / n)
    # At 0 and at 1 rounding must not leave the share outside its own interval.
    return max(0.0, min(value, middle - half)), min(1.0, max(value, middle + half))


def range_of_means(groups: Sequence[Sample]) -> Estimate:
    """The largest difference between the means of paired groups.

    The interval is that of all pairs together: a bootstrap interval for each, at Bonferroni's level.
    Its upper end is the highest of theirs, its lower end the highest that is above no difference.
    """

    def difference(a: Real, b: Real) -> Real:
        return np.asarray(a.mean(axis=-1) - b.mean(axis=-1))

    pairs = list(combinations(groups, 2))
    level = 1 - (1 - CONFIDENCE) / len(pairs)
    found = [bootstrapped("difference", difference, pair, level) for pair in pairs]
    return _largest(found, "largest difference of means, simultaneous bootstrap intervals")


def range_of_shares(groups: Sequence[Sequence[bool]]) -> Estimate:
    """The largest difference between the shares of groups; as for means, with Newcombe's intervals."""
    pairs = list(combinations(groups, 2))
    level = 1 - (1 - CONFIDENCE) / len(pairs)
    found = [difference_of_shares(one, other, level) for one, other in pairs]
    return _largest(found, "largest difference of shares, simultaneous Newcombe intervals")


def _largest(differences: Sequence[Estimate], method: str) -> Estimate:
    """The largest of several differences, whichever their signs."""
    if not all(one.n for one in differences):
        return no_runs()

    def p_value(threshold: float, at_least: bool) -> float:
        above = [
            min(one.p_value(threshold, True), one.p_value(-threshold, False)) for one in differences
        ]
        if at_least:  # one of them is enough, out of so many
            return min(1.0, 2 * len(differences) * min(above))
        # All of them must be smaller, on both sides.
        below = [
            max(one.p_value(threshold, False), one.p_value(-threshold, True)) for one in differences
        ]
        return max(below)

    return Estimate(
        value=max(abs(one.value) for one in differences),
        low=max(0.0, *(max(one.low, -one.high) for one in differences)),
        high=max(max(one.high, -one.low) for one in differences),
        n=min(one.n for one in differences),
        method=method,
        p_value=p_value,
    )


def bootstrapped(
    name: str,
    statistic: Callable[..., Real],
    samples: Sequence[Sample],
    confidence: float = CONFIDENCE,
) -> Estimate:
    """A statistic of paired samples, each of shape (n,), with a percentile bootstrap interval.

    ``statistic`` takes one array for each sample, shape (..., n), and answers with shape (...).
    """
    arrays = [np.asarray(sample, dtype=float) for sample in samples]
    n = len(arrays[0])
    if any(len(array) != n for array in arrays):
        raise ValueError(f"paired samples differ in length: {[len(array) for array in arrays]}")
    if not n:
        return no_runs(-np.inf, np.inf)
    resampled = np.asarray(statistic(*(array[_resamples(n)] for array in arrays)))
    tails = ((1 - confidence) / 2, (1 + confidence) / 2)
    low, high = np.quantile(resampled, tails)
    value = float(statistic(*arrays))
    method = f"{name}, bootstrap ({RESAMPLES:,} resamples, percentiles)"
    return Estimate(value, float(low), float(high), n, method, bootstrap_tail(resampled))


@cache
def _resamples(n: int) -> NDArray[np.int64]:
    """Which runs each resample draws, shape (resamples, n); the same for all samples of n."""
    return np.random.default_rng(SEED).integers(n, size=(RESAMPLES, n))


def _z(confidence: float) -> float:
    """The quantile of the normal distribution for an interval."""
    return float(special.ndtri((1 + confidence) / 2))


def spread(values: Sample) -> tuple[float, float]:
    """The 5th and the 95th percentile of runs: how they differ, not how sure an estimate is."""
    known = np.asarray(values, dtype=float)
    if not len(known):
        return np.nan, np.nan
    low, high = np.quantile(known, (0.05, 0.95))
    return float(low), float(high)


def holm(p_values: Sample) -> list[float]:
    """P values adjusted for their number by Holm's step-down method, in their order."""
    order = np.argsort(p_values, kind="stable")
    adjusted = np.empty(len(p_values))
    largest = 0.0
    for rank, index in enumerate(order):
        largest = max(largest, min(1.0, (len(p_values) - rank) * p_values[index]))
        adjusted[index] = largest
    return [float(value) for value in adjusted]
