"""Each statistic against scipy or a hand-made case; how often intervals hold is in test_coverage."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from tests.made_up import FROM, ONE, OTHER, UP_TO, part
from upswing.analysis import statistics, survival
from upswing.analysis.statistics import Estimate

SAMPLES = st.lists(st.integers(-4, 4).map(lambda x: x / 2), min_size=1, max_size=25)
"""Values of runs, many of them equal."""


@given(st.integers(0, 40), st.integers(1, 40), st.sampled_from([0.9, 0.95, 0.99]))
def test_wilson_is_scipys_for_whole_numbers(k, n, confidence):
    k = min(k, n)
    mine = statistics.wilson(k / n, n, confidence)
    theirs = stats.binomtest(k, n).proportion_ci(confidence, method="wilson")
    assert mine == pytest.approx((theirs.low, theirs.high), abs=1e-9)


def test_newcombe_by_hand():
    """Newcombe (1998), table II, case (a): 56/70 − 48/80 = 0.2, interval 0.0524 to 0.3339."""
    found = statistics.difference_of_shares((56, 70), (48, 80))
    assert (found.value, found.low, found.high) == pytest.approx((0.2, 0.0524, 0.3339), abs=1e-4)
    assert found.n == 70


@given(st.lists(st.integers(0, 9), min_size=1, max_size=30))
def test_locations_are_scipys(values):
    assert statistics.mean(values).value == pytest.approx(np.mean(values))
    assert statistics.median(values).value == pytest.approx(np.median(values))
    assert statistics.interquartile_mean(values).value == pytest.approx(
        stats.trim_mean(values, 0.25)
    )


def gamma(seed, n, scale=1.0):
    return np.random.default_rng(seed).gamma(2, scale, size=n)


def scipys(samples, statistic, paired=False):
    """Scipy's percentile interval of as many resamples."""
    return stats.bootstrap(
        samples, statistic, n_resamples=10_000, method="percentile", paired=paired, vectorized=True,
        rng=np.random.default_rng(1),
    ).confidence_interval  # fmt: skip


def assert_alike(mine, theirs):
    """Two bootstraps of the same data, within their own noise."""
    width = theirs.high - theirs.low
    assert (mine.low, mine.high) == pytest.approx((theirs.low, theirs.high), abs=0.03 * width)


def difference(x, y, axis):
    return x.mean(axis=axis) - y.mean(axis=axis)


def ratio(x, y, axis):
    return x.mean(axis=axis) / y.mean(axis=axis)


def test_the_bootstrap_is_scipys_within_its_own_noise():
    values = gamma(3, 30)
    assert_alike(statistics.mean(values), scipys((values,), np.mean))
    assert_alike(statistics.median(values), scipys((values,), np.median))


@pytest.mark.parametrize("sizes", [(30, 30), (30, 80)])
def test_two_samples_are_drawn_each_on_its_own_as_scipy_does(sizes):
    x, y = gamma(3, sizes[0], 2.0), gamma(4, sizes[1])
    for mine, statistic in (
        (statistics.difference_of_means(x, y), difference),
        (statistics.ratio_of_means(x, y), ratio),
    ):
        assert mine.value == pytest.approx(statistic(x, y, 0))
        assert mine.n == min(sizes)
        assert_alike(mine, scipys((x, y), statistic))


def test_the_difference_of_two_equal_samples_is_not_certain():
    """Runs of two cells that happen to agree are still two samples."""
    x = gamma(5, 40)
    found = statistics.difference_of_means(x, x)
    half = stats.norm.ppf(0.975) * np.sqrt(2 * x.var() / 40)
    assert found.value == 0
    assert (found.low, found.high) == pytest.approx((-half, half), rel=0.06)


def test_two_counts_of_the_same_runs_are_drawn_together_as_scipy_does():
    arrivals = gamma(6, 40, 10.0)
    unstoppable = arrivals * np.random.default_rng(7).uniform(0.1, 0.5, 40)
    mine = statistics.ratio_of_sums(unstoppable, arrivals)
    assert mine.value == pytest.approx(unstoppable.sum() / arrivals.sum())
    assert_alike(mine, scipys((unstoppable, arrivals), ratio, paired=True))
    same = statistics.ratio_of_sums(0.25 * arrivals, arrivals)
    assert (same.low, same.high) == pytest.approx((0.25, 0.25))


def test_pairs_are_drawn_together_as_scipy_does():
    x = gamma(5, 40)
    y = x + np.random.default_rng(8).normal(0, 0.2, 40)
    mine = statistics.difference_of_pairs(x, y)
    assert mine.value == pytest.approx(x.mean() - y.mean())
    assert_alike(mine, scipys((x, y), difference, paired=True))
    assert statistics.difference_of_pairs(x, x)[:3] == (0, 0, 0)
    apart = statistics.difference_of_means(x, y)
    assert apart.high - apart.low > 3 * (mine.high - mine.low)


def test_two_counts_of_the_same_runs_are_of_as_many_runs():
    with pytest.raises(ValueError, match=r"samples of the same runs differ: \[3, 2\]"):
        statistics.ratio_of_sums([1, 2, 3], [1, 2])


@pytest.mark.parametrize(("n", "number"), [(1, 0), (7, 0), (30, 1), (50, 2)])
def test_means_by_how_often_a_run_is_drawn_are_the_means_of_what_is_drawn(n, number):
    values = gamma(n, n)
    drawn = statistics._resamples(n, number)
    times = statistics._times_drawn(n, number)
    assert times.shape == drawn.shape == (statistics.RESAMPLES, n)
    assert (times.sum(axis=1) == n).all()
    np.testing.assert_allclose(times @ values / n, values[drawn].mean(axis=1))


def test_samples_of_as_many_runs_are_not_drawn_alike():
    one, other = (statistics._resamples(30, number) for number in (0, 1))
    assert (one == other).mean() == pytest.approx(1 / 30, abs=0.005)


def test_the_same_runs_give_the_same_interval():
    values = np.random.default_rng(0).normal(size=30)
    assert statistics.mean(values)[:4] == statistics.mean(values)[:4]


@given(SAMPLES, SAMPLES)
def test_the_share_of_pairs_is_that_of_all_pairs(x, y):
    plainly = np.mean([[1.0 if a > b else 0.5 if a == b else 0.0 for b in y] for a in x])
    assert statistics.share_of_pairs(x, y) == pytest.approx(plainly)
    assert statistics.share_of_pairs(y, x) == pytest.approx(1 - plainly)


@given(SAMPLES, SAMPLES)
def test_the_share_of_pairs_is_mann_and_whitneys(x, y):
    found = statistics.probability_greater(x, y)
    u = stats.mannwhitneyu(x, y, method="asymptotic").statistic
    assert found.value == pytest.approx(u / (len(x) * len(y)))
    assert found.n == min(len(x), len(y))
    assert 0 <= found.low <= found.value <= found.high <= 1


@pytest.mark.parametrize(("k", "n", "m"), [(0, 30, 30), (7, 30, 90), (30, 30, 31)])
def test_pairs_that_say_no_more_than_one_sample_have_its_interval(k, n, m):
    """With one value of Y between those of X the pairs are n runs of which k are greater."""
    found = statistics.probability_greater([1.0] * k + [-1.0] * (n - k), [0.0] * m)
    assert found[:3] == pytest.approx(statistics.share(k, n)[:3])
    turned = statistics.probability_greater([0.0] * m, [1.0] * k + [-1.0] * (n - k))
    assert turned[:3] == pytest.approx(statistics.share(n - k, n)[:3])


def test_the_smaller_sample_counts():
    one = statistics.probability_greater(range(5, 25), range(1_000))
    other = statistics.probability_greater(range(5, 1_005), range(20))
    assert one.n == other.n == 20
    assert one.high - one.low > 0.1


def test_pairs_that_all_agree_are_not_certain():
    found = statistics.probability_greater(range(1, 31), [0] * 30)
    assert found.value == 1
    assert found.low == pytest.approx(0.886, abs=1e-3)


def test_ties_count_half():
    found = statistics.probability_greater([1, 2, 3, 0], [1, 1, 3, 1])
    assert found.value == pytest.approx((0.5 * 3 + 3 + 3 + 0.5 + 0) / 16)


def test_the_largest_difference_is_that_of_its_pairs():
    """Of three groups, of which the first and the last lie furthest apart, whichever way round."""
    groups = [gamma(8, 30), gamma(9, 40) + 1, gamma(10, 50) + 3]
    for order in (groups, groups[::-1]):
        found = statistics.range_of_means(order)
        level = 1 - 0.05 / 3
        pair = statistics.of_means(
            "difference", lambda a, b: b - a, [order[0], order[2]], confidence=level
        )
        assert found.value == pytest.approx(abs(pair.value))
        assert (found.low, found.high) == pytest.approx(
            sorted((abs(pair.low), abs(pair.high))), rel=1e-6
        )
        assert found.n == 30


def test_the_largest_difference_of_shares_is_newcombes_at_bonferronis_level():
    groups = [(3, 30), (20, 40), (45, 50)]
    for order in (groups, groups[::-1]):
        found = statistics.range_of_shares(order)
        pair = statistics.difference_of_shares((45, 50), (3, 30), confidence=1 - 0.05 / 3)
        assert found[:4] == pytest.approx(pair[:4])


def test_kaplan_meier_is_the_plain_share_when_nobody_left_early():
    times = [100.0, 200.0, 300.0, None, None, None, None, None]
    assert survival.share_by(times, 250, 1_000).value == pytest.approx(2 / 8)
    assert survival.share_by(times, 1_000, 1_000).value == pytest.approx(3 / 8)
    assert survival.share_by([None] * 4, 500, 1_000).value == 0
    assert survival.share_by([1.0] * 4, 500, 1_000).value == 1


def test_median_time_with_runs_that_never_got_there():
    middle, low, high = survival.median_time([1, 2, 3, 4, 5, 6, 7, None, None], 10)
    assert middle == 5
    assert low < 5 < high
    assert survival.median_time([1, None, None, None], 10)[0] == np.inf
    assert survival.median_time([None, None], 10) == (np.inf, np.inf, np.inf)


@pytest.mark.parametrize("kind", ["ratio_of_means", "ratio_of_sums"])
@pytest.mark.parametrize("below", [[0.0] * 10, [0.0] * 9 + [1.0]])
def test_nothing_by_nothing_speaks_for_no_claim(kind, below):
    """Neither where every run has none, nor where a resample has none."""
    found = getattr(statistics, kind)([0.0] * 10, below)
    assert (found.low, found.high) == (-np.inf, np.inf)
    pair = {"measure": "falls", "per": "steps"} if kind == "ratio_of_sums" else {"measure": "falls"}
    cells = [ONE] if kind == "ratio_of_sums" else [ONE, OTHER]
    for bounds in (FROM, UP_TO):
        assert part(kind, cells, **pair, **bounds).verdict(found) == "inconclusive"


def test_no_runs_tell_nothing():
    some = [1.0, 2.0]
    for found in (
        statistics.share(0, 0),
        statistics.mean([]),
        statistics.median([]),
        statistics.difference_of_means([], some),
        statistics.ratio_of_means(some, []),
        statistics.ratio_of_sums([], []),
        statistics.probability_greater([], some),
        statistics.probability_greater(some, []),
        statistics.difference_of_shares((0, 0), (1, 2)),
        statistics.range_of_means([some, [], some]),
        statistics.range_of_shares([(1, 2), (0, 0)]),
        survival.share_by([], 1, 2),
    ):
        assert isinstance(found, Estimate)
        assert found.n == 0
        assert np.isnan(found.value)


def test_spread_is_of_the_runs_and_not_of_the_estimate():
    values = np.arange(101.0)
    assert statistics.spread(values) == pytest.approx((5, 95))
    assert statistics.mean(values).high - statistics.mean(values).low < 15
