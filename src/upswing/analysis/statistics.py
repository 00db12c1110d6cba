"""Numbers over runs → estimates with intervals. The unit is one run.

Every interval is one of 95 % for the estimate, unlike the spread, the 5th to 95th percentile of the
runs themselves. Runs of two cells are independent samples: those of one seed begin alike but soon
differ (their measures hardly correlate), so nothing is gained by pairing them. Bootstraps are seeded, so
that the same runs give the same interval.
"""

from collections.abc import Callable, Sequence
from functools import cache
from itertools import combinations
from math import hypot, sqrt
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


class Estimate(NamedTuple):
    """An estimate, its interval, and how it was reached."""

    value: float
    low: float
    high: float
    n: int  # runs, or pairs of runs
    method: str


def no_runs(low: float = 0.0, high: float = 1.0) -> Estimate:
    """What no runs tell: nothing."""
    return Estimate(np.nan, low, high, 0, "no runs")


def share(successes: int, n: int, confidence: float = CONFIDENCE) -> Estimate:
    """A share k of n with Wilson's interval; from 0 to 1 of no runs at all."""
    if not n:
        return no_runs()
    low, high = wilson(successes / n, n, confidence)
    return Estimate(successes / n, low, high, n, "share, Wilson")


Counted = tuple[int, int]
"""How many of how many."""


def difference_of_shares(x: Counted, y: Counted, confidence: float = CONFIDENCE) -> Estimate:
    """The share of x minus that of y, with Newcombe's interval from Wilson's of both."""
    if not x[1] or not y[1]:
        return no_runs(-1.0, 1.0)
    one, other = share(*x, confidence), share(*y, confidence)
    value = one.value - other.value
    low = value - hypot(one.value - one.low, other.high - other.value)
    high = value + hypot(one.high - one.value, other.value - other.low)
    n = min(x[1], y[1])
    return Estimate(value, low, high, n, "difference of shares, Newcombe")


def mean(values: Sample) -> Estimate:
    """The mean; bootstrap, percentiles."""
    return of_means("mean", lambda x: x, [values])


def median(values: Sample) -> Estimate:
    """The median; bootstrap, percentiles."""
    return bootstrapped("median", lambda x: _middle(x, (np.shape(x)[-1] - 1) // 2), values)


def interquartile_mean(values: Sample) -> Estimate:
    """The mean of the middle half; bootstrap, percentiles."""
    return bootstrapped("interquartile mean", lambda x: _middle(x, np.shape(x)[-1] // 4), values)


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
    """mean(x) / mean(y) of independent samples; bootstrap of each, percentiles."""
    return of_means("ratio of means", _ratio, [x, y])


def ratio_of_sums(x: Sample, y: Sample) -> Estimate:
    """sum(x) / sum(y) of two counts of the same runs; bootstrap of the runs, percentiles."""
    return of_means("ratio of sums", _ratio, [x, y], of_the_same_runs=True)


def _ratio(a: Real, b: Real) -> Real:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.divide(a, b))


def difference_of_means(x: Sample, y: Sample) -> Estimate:
    """mean(x) − mean(y) of independent samples; bootstrap of each, percentiles."""
    return of_means("difference of means", _difference, [x, y])


def difference_of_pairs(x: Sample, y: Sample) -> Estimate:
    """mean(x) − mean(y) of runs with the same seeds, in the same order; bootstrap of the pairs."""
    return of_means("difference of means, paired", _difference, [x, y], of_the_same_runs=True)


def _difference(a: Real, b: Real) -> Real:
    return a - b


def probability_greater(x: Sample, y: Sample) -> Estimate:
    """P(X > Y) + ½ P(X = Y) over all pairs of independent samples, with a safe interval.

    The share of pairs has a variance of at most p (1 − p) / min(n, m), whatever the distributions
    (Birnbaum and Klose 1957). So Wilson's interval for the smaller sample is wide enough, and it does
    not claim certainty where all pairs agree, as a bootstrap would.
    """
    if not len(x) or not len(y):
        return no_runs()
    value, n = share_of_pairs(x, y), min(len(x), len(y))
    low, high = wilson(value, n)
    return Estimate(value, low, high, n, "P(X > Y) over all pairs, Wilson for the smaller sample")


def share_of_pairs(x: Sample, y: Sample) -> float:
    """The share of all pairs in which x is the greater one, a tie being half."""
    a, b = np.sort(np.asarray(x, dtype=float)), np.asarray(y, dtype=float)
    below_or_equal = np.searchsorted(a, b, side="right")
    below = np.searchsorted(a, b, side="left")
    greater = len(a) - below_or_equal + 0.5 * (below_or_equal - below)
    return float(greater.sum() / (len(a) * len(b)))


def wilson(value: float, n: int, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Wilson's interval for a share ``value`` of ``n``, which need not be a whole number of them."""
    z = _z(confidence)
    middle = (value + z**2 / (2 * n)) / (1 + z**2 / n)
    half = z * sqrt(value * (1 - value) / n + z**2 / (4 * n**2)) / (1 + z**2 / n)
    # At 0 and at 1 rounding must not leave the share outside its own interval.
    return max(0.0, min(value, middle - half)), min(1.0, max(value, middle + half))


def range_of_means(groups: Sequence[Sample]) -> Estimate:
    """The largest difference between the means of independent groups.

    The interval is that of all pairs together: a bootstrap interval for each, at Bonferroni's level.
    Its upper end is the highest of theirs, its lower end the highest that is above no difference.
    """
    pairs = list(combinations(groups, 2))
    level = 1 - (1 - CONFIDENCE) / len(pairs)
    found = [of_means("difference", _difference, pair, level) for pair in pairs]
    return _largest(found, "largest difference of means, simultaneous bootstrap intervals")


def range_of_shares(groups: Sequence[Counted]) -> Estimate:
    """The largest difference between the shares of groups; as for means, with Newcombe's intervals."""
    pairs = list(combinations(groups, 2))
    level = 1 - (1 - CONFIDENCE) / len(pairs)
    found = [difference_of_shares(one, other, level) for one, other in pairs]
    return _largest(found, "largest difference of shares, simultaneous Newcombe intervals")


def _largest(differences: Sequence[Estimate], method: str) -> Estimate:
    """The largest of several differences, whichever their signs."""
    if not all(one.n for one in differences):
        return no_runs()

    return Estimate(
        value=max(abs(one.value) for one in differences),
        low=max(0.0, *(max(one.low, -one.high) for one in differences)),
        high=max(max(one.high, -one.low) for one in differences),
        n=min(one.n for one in differences),
        method=method,
    )


def of_means(
    name: str,
    statistic: Callable[..., Real],
    samples: Sequence[Sample],
    confidence: float = CONFIDENCE,
    *,
    of_the_same_runs: bool = False,
) -> Estimate:
    """A statistic of the means of samples, each of shape (n,), with a percentile bootstrap interval.

    Args:
        name: of the statistic, for readers.
        statistic: takes the mean of each sample, or arrays of means, and answers with the like.
        samples: independent ones, or with ``of_the_same_runs`` several measures of the same runs.
        confidence: that of the interval.
        of_the_same_runs: whether the samples are drawn together.
    """
    arrays = [np.asarray(sample, dtype=float) for sample in samples]
    if of_the_same_runs and len({len(array) for array in arrays}) > 1:
        raise ValueError(f"samples of the same runs differ: {[len(array) for array in arrays]}")
    n = min(len(array) for array in arrays)
    if not n:
        return no_runs(-np.inf, np.inf)
    means = (
        _times_drawn(len(array), 0 if of_the_same_runs else number) @ array / len(array)
        for number, array in enumerate(arrays)
    )
    value = float(statistic(*(array.mean() for array in arrays)))
    return _estimate(name, value, np.asarray(statistic(*means)), n, confidence)


def bootstrapped(name: str, statistic: Callable[[Real], Real], sample: Sample) -> Estimate:
    """A statistic of a sample of shape (n,), with a percentile bootstrap interval.

    ``statistic`` takes an array of shape (..., n) and answers with shape (...).
    """
    array = np.asarray(sample, dtype=float)
    if not len(array):
        return no_runs(-np.inf, np.inf)
    resampled = np.asarray(statistic(array[_resamples(len(array), 0)]))
    return _estimate(name, float(statistic(array)), resampled, len(array), CONFIDENCE)


def _estimate(name: str, value: float, resampled: Real, n: int, confidence: float) -> Estimate:
    tails = ((1 - confidence) / 2, (1 + confidence) / 2)
    # Nothing by nothing, in a resample: then anything is possible.
    known = np.isfinite(resampled).all()
    low, high = np.quantile(resampled, tails) if known else (-np.inf, np.inf)
    method = f"{name}, bootstrap ({RESAMPLES:,} resamples, percentiles)"
    return Estimate(value, float(low), float(high), n, method)


@cache
def _resamples(n: int, number: int) -> NDArray[np.int64]:
    """Which runs each resample draws, shape (resamples, n), for the sample of this number."""
    return np.random.default_rng([SEED, number]).integers(n, size=(RESAMPLES, n))


@cache
def _times_drawn(n: int, number: int) -> Real:
    """How often each resample draws each run, shape (resamples, n): a mean is then a product."""
    rows = np.arange(RESAMPLES)[:, None] * n
    drawn = np.bincount((_resamples(n, number) + rows).ravel(), minlength=RESAMPLES * n)
    return drawn.reshape(RESAMPLES, n).astype(float)


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
