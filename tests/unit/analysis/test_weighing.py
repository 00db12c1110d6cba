"""Claims over readings, weighed by what else the author reports, on made-up counts."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import integrate

from tests.made_up import FROM, part
from upswing.analysis.robustness import weighing
from upswing.analysis.robustness.weighing import (
    BELOW,
    COARSE,
    grade,
    likelihoods_drawn,
    priors,
    weigh,
)
from upswing.study.claims import Claim
from upswing.study.readings import options_of
from upswing.study.sweeps import Report, Sweep

SIMPLE, LARGE, MODULAR, TABLE = (
    "balancing/networks-5/alpha-1", "full-control/networks-30/alpha-1",
    "full-control/modular-networks-5/alpha-1", "balancing/table/alpha-1",
)  # fmt: skip
REPORTS = {
    "p7": Report(figure=7, cell=SIMPLE, shows="success"),
    "p9": Report(figure=9, cell=LARGE, shows="failure"),
    "p11": Report(figure=11, cell=MODULAR, shows="both"),
}
PRIOR_OF_SHARES = weighing.prior_of_shares
RATES = options_of("learning_rate")
GRID = Sweep(
    vary=("learning_rate",), how="grid", seeds=20, cells=(SIMPLE, LARGE, MODULAR), reports=REPORTS
)
READINGS = [{"learning_rate": rate} for rate in RATES]


@pytest.fixture(autouse=True)
def _flat(monkeypatch):
    """With a flat prior of shares weights are had by hand; what the prior is has tests of its own."""
    monkeypatch.setattr(weighing, "prior_of_shares", lambda *_: (1.0, 1.0))


def about(*cells, cell=None):
    """A claim with a part about each of these cells, shown by another."""
    where = {"upright_at_end": {"at_least": 0.9}}
    parts = [part("share", [one], where=where, **FROM) for one in cells]
    return Claim(statement="…", section="…", cell=cell, parts=parts)


OF_A_TABLE = about(TABLE, cell=TABLE)


def runs(p7, p9, p11, n=20, diverged=0):
    """Counts of a reading: so many of n runs succeed, so many diverged, and the rest fails."""
    return {
        name: (won, n - won - diverged, diverged)
        for name, won in zip(REPORTS, (p7, p9, p11), strict=True)
    }


def likelihood(p7, p9, p11, n=20):
    """L = p₇ (1 − p₉) p₁₁ (1 − p₁₁), each as (k + 1) / (n + 2)."""
    a, b, c = ((k + 1) / (n + 2) for k in (p7, p9, p11))
    return a * (1 - b) * c * (1 - c)


def few(*counted):
    """As many readings as there are counts, each with a rate of its own."""
    return READINGS[: len(counted)], list(counted)


def test_a_claim_weighs_as_much_as_the_readings_under_which_it_holds():
    counts = [(18, 1, 9), (10, 5, 3), (20, 20, 20)]
    readings, counted = few(*(runs(*k) for k in counts))
    probabilities = np.array([0.9, 0.2, 1.0])
    weights = [likelihood(*k) for k in counts]
    found = weigh(GRID, OF_A_TABLE, readings, probabilities, counted)
    expected = sum(p * w for p, w in zip(probabilities, weights, strict=True)) / sum(weights)
    assert found.share == pytest.approx(expected)
    assert found.low < found.share < found.high
    assert found.left_out == ()


@pytest.mark.parametrize("figure", [7, 9, 11])
@pytest.mark.parametrize("how", ["shown by", "a part about"])
def test_a_report_about_the_claims_own_cell_is_left_out(figure, how):
    """Under the one reading the report comes true, under the other not; nothing else parts them."""
    name = f"p{figure}"
    cell = REPORTS[name].cell
    claim = about(TABLE, cell=cell) if how == "shown by" else about(TABLE, cell)
    ends = {"success": (20, 0), "failure": (0, 20), "both": (10, 0)}[REPORTS[name].shows]
    counts = [{"p7": 10, "p9": 10, "p11": 10} | {name: won} for won in ends]
    readings, counted = few(*(runs(*k.values()) for k in counts))
    found = weigh(GRID, claim, readings, np.array([1.0, 0.0]), counted)
    assert found.left_out == (name,)
    assert found.share == pytest.approx(0.5)
    of_another = weigh(GRID, OF_A_TABLE, readings, np.array([1.0, 0.0]), counted)
    weights = [likelihood(*k.values()) for k in counts]
    assert of_another.share == pytest.approx(weights[0] / sum(weights))
    assert of_another.share > 0.8


def test_without_a_report_all_readings_weigh_the_same():
    claim = about(SIMPLE, LARGE, MODULAR)
    readings, counted = few(runs(20, 0, 10), runs(0, 20, 0), runs(1, 2, 3), runs(3, 2, 1))
    found = weigh(GRID, claim, readings, np.array([1.0, 0.0, 0.5, 0.1]), counted)
    assert found.left_out == ("p7", "p9", "p11")
    assert found[:3] == pytest.approx((0.4, 0.4, 0.4))


@pytest.mark.parametrize("p9", [0, 1])
def test_a_reading_whose_runs_diverged_has_next_to_no_weight(p9):
    """Its networks neither balance nor fail; that figure 9 shows a failure speaks for it no more."""
    finite, overflowing = runs(12, 10, 10, n=100), runs(0, p9, 0, n=100, diverged=99)
    readings, counted = few(finite, overflowing)
    found = weigh(GRID, OF_A_TABLE, readings, np.array([0.0, 1.0]), counted)
    assert found.share < 1e-4
    assert found.high < 1e-3


@given(
    st.lists(st.tuples(*[st.integers(0, 20)] * 3, st.floats(0, 1)), min_size=1, max_size=len(RATES))
)
def test_it_lies_between_the_readings_and_so_does_every_prior(rows):
    readings, counted = few(*(runs(*row[:3]) for row in rows))
    probabilities = np.array([row[3] for row in rows])
    found = weigh(GRID, OF_A_TABLE, readings, probabilities, counted)
    least, most = probabilities.min() - 1e-12, probabilities.max() + 1e-12
    assert all(least <= p <= most for p in (*found[:3], *found.by_prior.values()))
    turned = weigh(GRID, OF_A_TABLE, readings[::-1], probabilities[::-1], counted[::-1])
    assert turned.share == pytest.approx(found.share)


def test_the_interval_is_that_of_likelihoods_drawn_by_beta():
    """For two readings by another way: quantiles of the weighted share over draws of scipy's own."""
    counts = [(15, 4, 9), (8, 5, 3)]
    readings, counted = few(*(runs(*k) for k in counts))
    found = weigh(GRID, OF_A_TABLE, readings, np.array([1.0, 0.0]), counted)
    random = np.random.default_rng(5)
    drawn = []
    for k7, k9, k11 in counts:
        p7, p9, p11 = (random.beta(k + 1, 20 - k + 1, 100_000) for k in (k7, k9, k11))
        drawn.append(p7 * (1 - p9) * p11 * (1 - p11))
    low, high = np.quantile(drawn[0] / (drawn[0] + drawn[1]), (0.025, 0.975))
    assert (found.low, found.high) == pytest.approx((low, high), abs=0.02)


def test_of_runs_that_diverged_the_likelihood_is_drawn_lower():
    """1 − p₉ is then the share of runs that stayed finite and do not stand."""
    asked = {"p9": REPORTS["p9"]}
    counted = [runs(0, 5, 0), {"p9": (5, 8, 7)}, {"p9": (5, 0, 15)}]
    means = likelihoods_drawn(asked, counted).mean(axis=1)
    failing = [16 / 22, 16 / 22 * 9 / 17, 16 / 22 * 1 / 17]
    assert means == pytest.approx(failing, abs=0.01)


# Other priors, of a grid over all rates: each reading holds with a probability of its own.

PROBABILITIES = np.linspace(0.05, 0.9, len(RATES)) ** 2
COUNTS = [(20 - k, k // 2, (5 * k) % 13) for k in range(len(RATES))]
LIKELY = np.array([likelihood(*k) for k in COUNTS])


def over_rates():
    return weigh(GRID, OF_A_TABLE, READINGS, PROBABILITIES, [runs(*k) for k in COUNTS]).by_prior


def weighted(chosen):
    return float(np.average(PROBABILITIES[chosen], weights=LIKELY[chosen]))


def test_small_rates_alone():
    chosen = [number for number, rate in enumerate(RATES) if rate < 0.2]
    assert 0 < len(chosen) < len(RATES)
    assert over_rates()[f"only η < {BELOW}"] == pytest.approx(weighted(chosen))


def test_the_rates_of_a_coarse_grid_alone():
    chosen = [RATES.index(rate) for rate in COARSE]
    assert over_rates()["coarse grid of η"] == pytest.approx(weighted(chosen))


def test_even_in_log_is_an_integral_over_log():
    """By the trapezoidal rule, to which pieces between the middles come."""
    x = np.log(RATES)
    above, below = (
        integrate.trapezoid(values, x) for values in (PROBABILITIES * LIKELY, LIKELY)
    )  # fmt: skip
    assert over_rates()["even in log η"] == pytest.approx(above / below)


def test_even_in_log_does_not_ask_in_which_order_or_how_often_a_rate_stands():
    readings = [
        {"learning_rate": rate, "biases": biases}
        for biases in options_of("biases") for rate in RATES[::-1]
    ]  # fmt: skip
    prior = priors(GRID)["even in log η"](readings).reshape(3, -1)
    assert prior.sum(axis=1) == pytest.approx([np.log(RATES[-1] / RATES[0])] * 3)
    # 0.03 stands at the end and has half of the way to 0.05.
    assert prior[:, -1] == pytest.approx([np.log(0.05 / 0.03) / 2] * 3)


def test_single_changes_alone():
    sweep = Sweep(vary=("first_q", "reset"), how="pairs", seeds=1, cells=(TABLE,))
    readings = [{}, {"first_q": "random"}, {"first_q": "random", "reset": "terminal"}]
    found = weigh(sweep, OF_A_TABLE, readings, np.array([1.0, 0.5, 0.0]), [{}] * 3)
    assert found.share == pytest.approx(0.5)
    assert found.by_prior == {"one change at most": pytest.approx(0.75)}


def test_a_grid_without_rates_has_no_other_prior():
    sweep = Sweep(vary=("biases",), how="grid", seeds=1, cells=(TABLE,))
    readings = [{"biases": option} for option in options_of("biases")]
    assert weigh(sweep, OF_A_TABLE, readings, np.array([1.0, 0.0, 0.5]), [{}] * 3).by_prior == {}


@pytest.mark.parametrize(("a", "b"), [(0.3, 2.0), (2.0, 2.0), (5.0, 1.0)])
def test_the_prior_of_shares_is_that_which_they_come_from(a, b):
    random = np.random.default_rng(3)
    n = random.integers(20, 400, 2_000)
    won = random.binomial(n, random.beta(a, b, 2_000))
    assert PRIOR_OF_SHARES(won, n) == pytest.approx((a, b), rel=0.15)


def test_few_runs_are_not_flattered():
    """Two hundred readings without a success in a few runs, and some with many runs that have some."""
    counted = [{"p11": (0, 24, 0)}] * 200 + [{"p11": (170, 830, 0)}] * 4
    asked = {"p11": REPORTS["p11"]}
    with pytest.MonkeyPatch.context() as context:
        context.setattr(weighing, "prior_of_shares", PRIOR_OF_SHARES)
        own = weighing.likelihoods(asked, counted)
    flat = weighing.likelihoods(asked, counted)
    assert own[0] < 0.1 * flat[0]
    assert own[-1] == pytest.approx(flat[-1], rel=0.02)
    assert own[-1] == pytest.approx(0.17 * 0.83, rel=0.02)


@pytest.mark.parametrize(
    ("share", "expected"),
    [
        (1.0, "holds"), (0.95, "holds"), (0.949, "depends on the reading"), (0.5, "depends on the reading"),
        (0.051, "depends on the reading"), (0.05, "fails"), (0.0, "fails"),
    ],
)  # fmt: skip
def test_grades(share, expected):
    assert grade(share) == expected
