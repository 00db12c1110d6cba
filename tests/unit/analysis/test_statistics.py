"""Each statistic against scipy, a hand-made case, or its coverage on data whose truth is known."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from upswing.analysis import statistics, survival
from upswing.analysis.statistics import Estimate

TRIALS = 1_000


def coverage(estimate, draw, truth):
    """The share of 1,000 data sets whose interval holds the truth."""
    rng = np.random.default_rng(7)
    inside = 0
    for _ in range(TRIALS):
        found = estimate(*draw(rng))
        inside += found.low - 1e-12 <= truth <= found.high + 1e-12
    return inside / TRIALS


@pytest.fixture
def few_resamples(monkeypatch):
    """A coarser bootstrap, for as many data sets as coverage takes."""
    monkeypatch.setattr(statistics, "RESAMPLES", 1_000)
    statistics._resamples.cache_clear()
    yield
    statistics._resamples.cache_clear()


@pytest.mark.parametrize("p", [0.1, 0.3, 0.5, 0.95])
def test_coverage_of_a_share_is_that_of_wilson(p):
    """Of a share coverage is known exactly: the sum over k of what the binomial gives it."""
    k = np.arange(31)
    inside = [(e := statistics.share(int(i), 30)).low <= p <= e.high for i in k]
    exact = stats.binom.pmf(k, 30, p)[inside].sum()
    found = coverage(statistics.share, lambda rng: (int(rng.binomial(30, p)), 30), p)
    assert found == pytest.approx(exact, abs=3 * np.sqrt(exact * (1 - exact) / TRIALS))
    assert exact > 0.92


# A percentile bootstrap of n = 30 is known to fall a little short of 95 %: 93 to 94 %. The Monte Carlo
# error of 1,000 data sets (three times 0.7 %) comes on top.
ROOM = (0.915, 0.975)


@pytest.mark.usefixtures("few_resamples")
@pytest.mark.parametrize("name", ["mean", "median", "interquartile_mean"])
@pytest.mark.parametrize("shape", ["normal", "uniform"])
def test_coverage_of_locations(name, shape):
    draw = {
        "normal": lambda rng: (rng.normal(5, 2, 30),),
        "uniform": lambda rng: (rng.uniform(4, 6, 30),),
    }[shape]
    assert ROOM[0] < coverage(statistics.LOCATIONS[name], draw, 5.0) < ROOM[1]


@pytest.mark.usefixtures("few_resamples")
def test_coverage_of_differences_and_ratios_of_pairs():
    def draw(rng):
        common = rng.normal(size=30)
        return 6 + common + rng.normal(size=30), 4 + common + rng.normal(size=30)

    assert ROOM[0] < coverage(statistics.difference_of_means, draw, 2.0) < ROOM[1]
    assert ROOM[0] < coverage(statistics.ratio_of_means, draw, 1.5) < ROOM[1]


def test_coverage_of_a_probability_and_of_a_difference_of_shares():
    # P(X > Y) for normals one standard deviation of the difference apart
    truth = float(stats.norm.cdf(1))
    scale = 1 / np.sqrt(2)
    found = coverage(
        statistics.probability_greater,
        lambda rng: (rng.normal(1, scale, 30), rng.normal(0, scale, 30)),
        truth,
    )
    assert ROOM[0] < found < 0.985
    found = coverage(
        statistics.difference_of_shares,
        lambda rng: (rng.random(30) < 0.7, rng.random(30) < 0.4),
        0.3,
    )
    assert ROOM[0] < found < 0.985


def test_coverage_of_a_share_by_a_time():
    truth = float(stats.expon.cdf(1.0))

    def draw(rng):
        times = [t if t < 2 else None for t in rng.exponential(size=30)]
        return (times,)

    found = coverage(lambda times: survival.share_by(times, 1.0, 2.0), draw, truth)
    assert ROOM[0] < found < 0.985


@pytest.mark.usefixtures("few_resamples")
@pytest.mark.parametrize("means", [(0, 0, 0), (0, 0, 0.5), (0, 0.2, 0.4), (0, 0, 2)])
def test_coverage_of_the_largest_difference(means):
    """Simultaneous intervals cover at least as often as they say, equal means included."""

    def draw(rng):
        return ([rng.normal(mean, 1, 30) for mean in means],)

    assert coverage(statistics.range_of_means, draw, max(means) - min(means)) > ROOM[0]


@pytest.mark.parametrize("shares", [(0.5, 0.5, 0.5), (0.2, 0.5, 0.8), (0, 0, 1)])
def test_coverage_of_the_largest_difference_of_shares(shares):
    def draw(rng):
        return ([rng.random(30) < p for p in shares],)

    assert coverage(statistics.range_of_shares, draw, max(shares) - min(shares)) > ROOM[0]


def test_coverage_of_the_median_time():
    """The interval of Kaplan and Meier's median, with a third of the runs censored."""
    rng = np.random.default_rng(2)
    inside = 0
    for _ in range(TRIALS):
        times = [t if t < 1.1 else None for t in rng.exponential(size=30)]
        _, low, high = survival.median_time(times, 1.1)
        inside += low <= np.log(2) <= high
    assert ROOM[0] < inside / TRIALS < 0.99


@given(st.integers(0, 40), st.integers(1, 40))
def test_wilson_is_scipys_for_whole_numbers(k, n):
    k = min(k, n)
    mine = statistics.wilson(k / n, n)
    theirs = stats.binomtest(k, n).proportion_ci(0.95, method="wilson")
    assert mine == pytest.approx((theirs.low, theirs.high), abs=1e-9)


def test_newcombe_by_hand():
    """Newcombe (1998), table II, case (a): 56/70 − 48/80 = 0.2, interval 0.0524 to 0.3339."""
    found = statistics.difference_of_shares([True] * 56 + [False] * 14, [True] * 48 + [False] * 32)
    assert (found.value, found.low, found.high) == pytest.approx((0.2, 0.0524, 0.3339), abs=1e-4)


@given(st.lists(st.integers(0, 9), min_size=1, max_size=30))
def test_locations_are_scipys(values):
    assert statistics.mean(values).value == pytest.approx(np.mean(values))
    assert statistics.median(values).value == pytest.approx(np.median(values))
    assert statistics.interquartile_mean(values).value == pytest.approx(
        stats.trim_mean(values, 0.25)
    )


def test_the_bootstrap_is_scipys_within_its_own_noise():
    values = np.random.default_rng(3).gamma(2, size=30)
    mine = statistics.mean(values)
    theirs = stats.bootstrap(
        (values,), np.mean, n_resamples=10_000, method="percentile", rng=np.random.default_rng(1)
    ).confidence_interval
    width = theirs.high - theirs.low
    assert (mine.low, mine.high) == pytest.approx((theirs.low, theirs.high), abs=0.03 * width)


def test_the_same_runs_give_the_same_interval():
    values = np.random.default_rng(0).normal(size=30)
    assert statistics.mean(values)[:4] == statistics.mean(values)[:4]


def test_pairs_that_all_agree_are_not_certain():
    found = statistics.probability_greater(range(1, 31), [0] * 30)
    assert found.value == 1
    assert found.low == pytest.approx(0.886, abs=1e-3)


def test_ties_count_half():
    found = statistics.probability_greater([1, 2, 3, 0], [1, 1, 3, 1])
    assert found.value == pytest.approx((0.5 + 1 + 0.5 + 0) / 4)


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


def test_holm_by_hand():
    """Steps of 4, 3, 2, 1 times the p value, never falling, in the order given."""
    assert statistics.holm([0.01, 0.04, 0.03, 0.005]) == pytest.approx([0.03, 0.06, 0.06, 0.02])
    assert statistics.holm([0.9, 0.8]) == [1.0, 1.0]


@given(st.lists(st.floats(0, 1), min_size=1, max_size=20))
def test_holm_never_lowers_a_p_value_and_never_exceeds_bonferroni(p_values):
    adjusted = statistics.holm(p_values)
    for before, after in zip(p_values, adjusted, strict=True):
        assert before <= after + 1e-12
        assert after <= min(1.0, len(p_values) * max(p_values)) + 1e-12
    assert min(adjusted) == pytest.approx(min(1.0, len(p_values) * min(p_values)))


@pytest.mark.parametrize("at_least", [True, False])
def test_p_values_of_shares_are_scipys(at_least):
    side = "greater" if at_least else "less"
    found = statistics.share(26, 30).p_value(0.8, at_least)
    assert found == pytest.approx(stats.binomtest(26, 30, 0.8, side).pvalue)


def test_p_values_of_a_bootstrap_are_small_far_from_the_threshold():
    found = statistics.mean(np.random.default_rng(0).normal(5, 1, 30))
    assert found.p_value(3.0, True) == pytest.approx(1 / 10_001)
    assert found.p_value(7.0, True) == 1
    assert 0.2 < found.p_value(found.value, True) < 0.8


def test_nothing_by_nothing_speaks_for_no_claim():
    found = statistics.ratio_of_means([0.0] * 10, [0.0] * 10)
    assert found.p_value(0.5, True) == found.p_value(0.5, False) == 1


def test_the_p_value_of_a_difference_looks_at_the_side_of_the_threshold():
    found = statistics.difference_of_shares([True] * 30, [False] * 30)
    assert 1e-12 < found.p_value(0.5, True) < 1e-5
    assert found.p_value(0.5, False) == 1


def test_no_runs_tell_nothing():
    for found in (statistics.share(0, 0), statistics.mean([]), survival.share_by([], 1, 2)):
        assert isinstance(found, Estimate)
        assert found.n == 0
        assert found.p_value(0.5, True) == 1


def test_spread_is_of_the_runs_and_not_of_the_estimate():
    values = np.arange(101.0)
    assert statistics.spread(values) == pytest.approx((5, 95))
    assert statistics.mean(values).high - statistics.mean(values).low < 15
