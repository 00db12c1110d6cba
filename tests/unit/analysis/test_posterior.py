"""How probable a claim is, given the runs of a reading: against scipy and against the truth."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from tests.made_up import FROM, NOISE, ONE, OTHER, THIRD, UP_TO, ZERO, N, made_up, part, share_of
from upswing.analysis import posterior
from upswing.analysis.posterior import beyond, draws, probability
from upswing.study.claims import Claim

ERROR = 3 * 0.5 / np.sqrt(posterior.DRAWS)
"""Three times the largest Monte Carlo error of a share of the draws."""

SUCCESS = {"swing_ups": {"at_least": 1}}


def jeffreys(k, n=N):
    """The posterior of a share under Jeffreys' prior."""
    return stats.beta(k + 0.5, n - k + 0.5)


@pytest.mark.parametrize("k", [0, 6, 30, 47, 48, 51, 60])
def test_a_share_is_a_beta(tmp_path, k):
    results = made_up(tmp_path, swing_ups=[share_of(k / N), ZERO, ZERO])
    for bounds, expected in ((FROM, jeffreys(k).sf(0.8)), (UP_TO, jeffreys(k).cdf(0.2))):
        asked = part("share", [ONE], where=SUCCESS, **bounds)
        assert beyond(results, asked, (ONE,)) == pytest.approx(expected, abs=ERROR)


def test_its_draws_are_the_betas(tmp_path):
    results = made_up(tmp_path, swing_ups=[share_of(0.7), ZERO, ZERO])
    drawn = draws(results, part("share", [ONE], where=SUCCESS, **FROM), (ONE,))
    assert drawn.shape == (posterior.DRAWS,)
    assert stats.kstest(drawn, jeffreys(42).cdf).pvalue > 0.01


def test_shares_of_two_cells_are_independent(tmp_path):
    """Against the integral over both betas."""
    results = made_up(tmp_path, swing_ups=[share_of(0.6), share_of(0.5), share_of(0.1)])
    asked = part("difference_of_shares", [ONE, OTHER], where=SUCCESS, at_least=0.1, partly=0)
    x = np.linspace(0, 1, 20_001)
    over = np.trapezoid(jeffreys(30).pdf(x) * jeffreys(36).sf(x + 0.1), x)
    assert beyond(results, asked, (ONE, OTHER)) == pytest.approx(over, abs=ERROR)


def test_the_range_of_shares_is_that_of_independent_betas(tmp_path):
    results = made_up(tmp_path, swing_ups=[share_of(0.6), share_of(0.5), share_of(0.55)])
    asked = part("range_of_shares", [ONE, OTHER, THIRD], where=SUCCESS, **FROM)
    others = [jeffreys(k).rvs(20_000, random_state=k) for k in (36, 30, 33)]
    drawn = draws(results, asked, (ONE, OTHER, THIRD))
    assert stats.ks_2samp(drawn, np.ptp(others, axis=0)).pvalue > 0.01


def test_of_equal_counts_each_may_be_the_greater(tmp_path):
    results = made_up(tmp_path, swing_ups=[share_of(0.5), share_of(0.5), ZERO])
    asked = part("difference_of_shares", [ONE, OTHER], where=SUCCESS, at_least=0, partly=0)
    assert beyond(results, asked, (ONE, OTHER)) == pytest.approx(0.5, abs=ERROR)


def rubin(values):
    """The standard error of a mean in the Bayesian bootstrap."""
    return values.std() / np.sqrt(len(values) + 1)


def test_means_spread_as_in_the_bayesian_bootstrap(tmp_path):
    one, other = 2 + 5 * NOISE, 1 + 10 * NOISE[::-1]
    results = made_up(tmp_path, swing_ups=[one, other, ZERO])
    middle = draws(results, part("location", [ONE], measure="swing_ups", **FROM), (ONE,))
    assert middle.mean() == pytest.approx(one.mean(), abs=4 * rubin(one) / np.sqrt(posterior.DRAWS))
    assert middle.std() == pytest.approx(rubin(one), rel=0.07)
    asked = part("difference_of_means", [ONE, OTHER], measure="swing_ups", **FROM)
    apart = draws(results, asked, (ONE, OTHER))
    spread = np.hypot(rubin(one), rubin(other))
    assert apart.mean() == pytest.approx(one.mean() - other.mean(), abs=4 * spread / 40)
    assert apart.std() == pytest.approx(spread, rel=0.07)


def test_of_pairs_the_differences_are_weighed(tmp_path):
    one, other = np.arange(N) + NOISE, np.arange(N) + NOISE[::-1]
    results = made_up(tmp_path, swing_ups=[one, other, ZERO])
    asked = part("difference_of_means", [ONE, OTHER], measure="swing_ups", paired=True, **FROM)
    drawn = draws(results, asked, (ONE, OTHER))
    spread = rubin(one - other)
    assert drawn.mean() == pytest.approx((one - other).mean(), abs=4 * spread / 40)
    assert drawn.std() == pytest.approx(spread, rel=0.07)


@pytest.mark.parametrize("shift", [-2, -1, 0, 1, 2])
def test_a_mean_is_beyond_its_threshold_as_a_normal_is(tmp_path, shift):
    """So many of its own standard errors above: 60 runs are nearly a normal."""
    values = 0.8 + NOISE - NOISE.mean() + shift * rubin(NOISE)
    results = made_up(tmp_path, swing_ups=[values, ZERO, ZERO])
    asked = part("location", [ONE], measure="swing_ups", **FROM)
    assert beyond(results, asked, (ONE,)) == pytest.approx(stats.norm.cdf(shift), abs=ERROR)


@pytest.mark.parametrize(
    ("kind", "cells", "truth"),
    [("ratio_of_means", (ONE, OTHER), 0.5), ("ratio_of_sums", (ONE,), 0.25), ("range_of_means", (ONE, OTHER, THIRD), 3.0)],
)  # fmt: skip
def test_ratios_and_ranges_are_near_the_truth(tmp_path, kind, cells, truth):
    """Of many made-up studies the truth is drawn as often below as above, within their number."""
    random = np.random.default_rng(11)
    asked = part(kind, cells, measure="swing_ups", at_least=truth, partly=truth,
                 **({"per": "falls"} if kind == "ratio_of_sums" else {}))  # fmt: skip
    found, results = [], made_up(tmp_path)
    for _ in range(60):
        means = {"swing_ups": (1.0, 2.0, 4.0), "falls": (4.0, 1.0, 1.0)}
        for name, of in means.items():
            results.runs[name] = np.concatenate([random.normal(mean, 0.3, N) for mean in of])
        drawn = draws(results, asked, cells)
        assert np.median(drawn) == pytest.approx(truth, rel=0.15)
        found.append(beyond(results, asked, cells))
    assert stats.kstest(found, "uniform").pvalue > 0.01


def test_counts_of_the_same_runs_are_weighed_together(tmp_path):
    results = made_up(tmp_path, swing_ups=[np.arange(N) / 4.0, ZERO, ZERO])
    asked = part("ratio_of_sums", [ONE], measure="swing_ups", per="falls", **FROM)
    assert draws(results, asked, (ONE,)) == pytest.approx(0.25)


def test_pairs_know_no_more_than_the_smaller_sample(tmp_path):
    """The one value of the other cell lies between those of the first: k of n runs are greater."""
    results = made_up(tmp_path, swing_ups=[share_of(0.75) - 0.5, ZERO, ZERO])
    asked = part("probability_greater", [ONE, OTHER], measure="swing_ups", **FROM)
    expected = jeffreys(45).sf(0.8)
    assert beyond(results, asked, (ONE, OTHER)) == pytest.approx(expected, abs=ERROR)


def test_all_parts_must_hold_in_all_their_cells(tmp_path):
    results = made_up(tmp_path, swing_ups=[share_of(0.85), share_of(0.8), share_of(0.75)])
    each = part("share", [], each=[ONE, OTHER], where=SUCCESS, **FROM)
    never_asked = part(
        "share", [ONE], where=SUCCESS, at_most=0, partly=0, only_if={"ties": "first"}
    )
    claim = Claim(
        statement="…", section="…", parts=[each, part("share", [THIRD], where=SUCCESS, **FROM), never_asked]
    )  # fmt: skip
    expected = np.prod([jeffreys(k).sf(0.8) for k in (51, 48, 45)])
    assert probability(results, claim) == pytest.approx(expected, abs=ERROR)
    asked = never_asked.model_copy(update={"only_if": {"ties": "random"}})
    both = claim.model_copy(update={"parts": (*claim.parts[:2], asked)})
    assert probability(results, both) == pytest.approx(0, abs=1e-3)


def test_what_a_policy_on_the_tiles_can_do_is_a_share_of_the_starts(tmp_path):
    results = made_up(tmp_path)
    results.__dict__["tile_policy"] = pd.DataFrame({"success": [True] * 3 + [False] * 13})
    claim = Claim(statement="…", section="…", parts=[part("share_represented", [], **UP_TO)])
    assert probability(results, claim) == pytest.approx(jeffreys(3, 16).cdf(0.2), abs=ERROR)


def test_of_no_runs_a_share_is_anything_and_a_mean_is_beyond_nothing(tmp_path):
    results = made_up(
        tmp_path, swing_ups=[ZERO, ZERO, ZERO], diverged_at=[ZERO + 1, ZERO + 1, ZERO]
    )
    shares = part("share", [ONE], where=SUCCESS, at_least=0.5, partly=0.5)
    assert beyond(results, shares, (ONE,)) == pytest.approx(0.5, abs=ERROR)
    pairs = part("probability_greater", [ONE, THIRD], measure="swing_ups", at_least=0.5, partly=0.5)
    assert beyond(results, pairs, (ONE, THIRD)) == pytest.approx(0.5, abs=ERROR)
    for bounds in (FROM, UP_TO):
        means = part("difference_of_means", [ONE, THIRD], measure="swing_ups", **bounds)
        assert beyond(results, means, (ONE, THIRD)) == 0
