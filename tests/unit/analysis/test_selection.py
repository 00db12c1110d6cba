"""The rule that selects the networks' default reading, and its evidence."""

import itertools
import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from tests.unit.analysis.test_weighing import LARGE, MODULAR, REPORTS, SIMPLE
from upswing.analysis.robustness.selection import DRAWS, counts, select
from upswing.runs.rows import framed
from upswing.runs.study_file import read_study
from upswing.study.config import load
from upswing.study.paths import SELECTION
from upswing.study.readings import Readings, options_of
from upswing.study.sweeps import canonical_of

CELLS = {"p7": SIMPLE, "p9": LARGE, "p11": MODULAR}
VARIED = ("reward_unit", "biases", "initial_weights", "learning_rate")
ERROR = 3 * 0.5 / np.sqrt(DRAWS)


def runs_of(readings, successes, n=20, diverged=0):
    """Runs of the three cells: so many of each succeed, and of the others so many diverged."""
    rows = []
    for (name, cell), k in zip(CELLS.items(), successes, strict=True):
        for seed in range(n):
            won = seed < k
            rows.append(
                {
                    "readings": canonical_of(readings), "cell": cell, "seed": seed, "name": name,
                    "falls_last_fifth": 0 if won or cell != SIMPLE else 3,
                    "upright_at_end": 0.95 if won or cell == SIMPLE else 0.5,
                    "upright_share": 0.5 if won else 0.95,  # of no interest
                    "diverged_at": 17 if n - seed <= diverged else None,
                }
            )  # fmt: skip
    return framed(rows)


def options(selected):
    return [json.loads(text) for text in selected["readings"]]


NONE, HIDDEN, BOTH = ({"biases": option} for option in ("none", "hidden", "both"))


def test_the_likelihood_is_that_of_the_ledger():
    runs = pd.concat(
        [runs_of(BOTH, (20, 20, 10)), runs_of(NONE, (19, 0, 9)), runs_of(HIDDEN, (19, 0, 9))]
    )
    chosen = select(runs, REPORTS)
    p7, p9, p11 = 20 / 22, 1 / 22, 10 / 22
    assert chosen["biases"].tolist() == ["none", "hidden", "both"]  # equal ones in their order
    assert chosen.at[0, "likelihood"] == pytest.approx(p7 * (1 - p9) * p11 * (1 - p11))
    assert chosen.at[2, "likelihood"] == pytest.approx(21 / 22 * (1 / 22) * (11 / 22) ** 2)
    assert chosen.loc[0, ["p7_successes", "p9_successes", "p11_successes"]].tolist() == [19, 0, 9]
    assert chosen.loc[0, ["p7_failures", "p9_failures", "p11_failures"]].tolist() == [1, 20, 11]
    assert chosen.loc[0, ["p7", "p9", "p11"]].tolist() == pytest.approx([p7, p9, p11])
    assert options(chosen) == [NONE, HIDDEN, BOTH]


def test_readings_are_compared_within_a_round_only():
    """One run that succeeds is (1 + 1) / (1 + 2); it must not stand before 84 of 100."""
    lucky, steady, poor = runs_of(NONE, (1, 0, 1), 2), runs_of(HIDDEN, (84, 16, 50), 100), runs_of(BOTH, (50, 50, 50), 100)  # fmt: skip
    chosen = select(pd.concat([lucky, poor, steady]), REPORTS)
    assert options(chosen) == [HIDDEN, BOTH, NONE]
    assert chosen["runs"].tolist() == [300, 300, 6]
    assert chosen.at[2, "likelihood"] > chosen.at[1, "likelihood"]
    assert chosen["best"].tolist() == pytest.approx([1, 0, 0], abs=0.01)
    assert chosen.at[2, "best"] == 0


def test_more_seeds_of_a_reading_are_counted_with_those_before():
    first, later = runs_of(NONE, (5, 2, 5), 10), runs_of(NONE, (8, 1, 3), 10)
    later["seed"] += 10
    (row,) = select(pd.concat([first, later]), REPORTS).to_dict("records")
    assert (row["runs"], row["p7_successes"], row["p11_failures"]) == (60, 13, 12)


def test_runs_that_diverged_lower_the_likelihood_and_count_for_nothing():
    """Each reading has as many that succeed; of the others ever more diverged in place of failing."""
    numbers = (0, 1, 4, 8)
    readings = [
        {"biases": "none", "learning_rate": rate}
        for rate in options_of("learning_rate")[: len(numbers)]
    ]
    runs = [
        runs_of(one, (10, 10, 10), diverged=k) for one, k in zip(readings, numbers, strict=True)
    ]
    chosen = select(pd.concat(runs), REPORTS)
    assert options(chosen) == readings
    for number, k in enumerate(numbers):
        lost = (11 - k) / 22
        expected = 11 / 22 * lost * (11 / 22 * lost)
        assert chosen.at[number, "likelihood"] == pytest.approx(expected)
        for name in CELLS:
            of = ("successes", "failures", "diverged")
            assert chosen.loc[number, [f"{name}_{what}" for what in of]].tolist() == [10, 10 - k, k]
    assert chosen["best"].is_monotonic_decreasing
    # Though they "stand" in their rows, those that diverged are no successes.
    (row,) = select(runs_of(NONE, (20, 20, 20), diverged=20), REPORTS).to_dict("records")
    assert [row[f"{name}_successes"] for name in CELLS] == [0, 0, 0]
    assert row["likelihood"] == pytest.approx((1 / 22) ** 4)


def test_one_of_them_is_the_best():
    runs = [runs_of({"biases": b, "initial_weights": w}, (12 + i, 3, 8 + i))
            for i, (b, w) in enumerate(itertools.product(options_of("biases"), [1, 0.5]))]  # fmt: skip
    chosen = select(pd.concat(runs), REPORTS)
    assert chosen["best"].sum() == pytest.approx(1)
    assert (chosen["low"] < chosen["likelihood"]).all()
    assert (chosen["likelihood"] < chosen["high"]).all()
    alike = select(pd.concat([runs_of(one, (12, 3, 8)) for one in (NONE, HIDDEN, BOTH)]), REPORTS)
    assert alike["best"].tolist() == pytest.approx([1 / 3] * 3, abs=ERROR)


def test_the_probability_to_be_the_best_is_that_of_betas():
    """Of two readings that differ in figure 7 alone: the greater of two betas."""
    one, other = {"p7": 15}, {"p7": 12}
    reports = {"p7": REPORTS["p7"]}
    runs = pd.concat([runs_of(NONE, (one["p7"], 0, 0)), runs_of(HIDDEN, (other["p7"], 0, 0))])
    chosen = select(runs, reports)
    x = np.linspace(0, 1, 20_001)
    first, second = (stats.beta(k["p7"] + 1, 21 - k["p7"]) for k in (one, other))
    expected = np.trapezoid(first.pdf(x) * second.cdf(x), x)
    assert chosen.at[0, "best"] == pytest.approx(expected, abs=ERROR)
    assert chosen.loc[0, ["low", "high"]].tolist() == pytest.approx(
        first.ppf([0.025, 0.975]), abs=0.02
    )


def test_a_reading_that_lacks_runs_of_a_report_is_not_counted():
    runs = pd.concat([runs_of(NONE, (5, 5, 5)), runs_of(BOTH, (5, 5, 5))])
    incomplete = runs[(runs["cell"] != LARGE) | (runs["readings"] == canonical_of(NONE))]
    assert list(counts(incomplete, REPORTS)) == [canonical_of(NONE)]
    assert options(select(incomplete, REPORTS)) == [NONE]


# What the project's own selection came to.


@pytest.fixture
def evidence():
    return pd.read_csv("report/selection.csv")


def text_of(value):
    return f"{value:g}" if isinstance(value, float | int) else str(value)


def test_the_default_is_the_reading_that_the_rule_selected(evidence):
    readings = load(Path("config/config.yaml")).readings
    for configured in (readings, Readings()):
        for name in VARIED:
            assert text_of(evidence.at[0, name]) == text_of(getattr(configured, name))


def test_the_evidence_is_of_every_reading_of_the_grid_once(evidence):
    assert len(evidence) == 3 * 3 * 3 * 12
    grid = itertools.product(*(map(text_of, options_of(name)) for name in VARIED))
    rows = zip(*(evidence[name].map(text_of) for name in VARIED), strict=True)
    assert sorted(rows) == sorted(grid)


def test_those_of_the_last_round_stand_first_and_each_round_by_likelihood(evidence):
    assert evidence["runs"].is_monotonic_decreasing
    for _, of_a_round in evidence.groupby("runs"):
        assert of_a_round["likelihood"].is_monotonic_decreasing
    assert evidence["best"].sum() == pytest.approx(1, abs=1e-4)
    assert (evidence.loc[evidence["runs"] < evidence["runs"].max(), "best"] == 0).all()


def test_the_likelihoods_of_the_evidence_are_those_of_its_counts(evidence):
    def estimate(name, what):
        n = sum(evidence[f"{name}_{one}"] for one in ("successes", "failures", "diverged"))
        return (evidence[f"{name}_{what}"] + 1) / (n + 2)

    expected = (
        estimate("p7", "successes") * estimate("p9", "failures")
        * estimate("p11", "successes") * estimate("p11", "failures")
    )  # fmt: skip
    np.testing.assert_allclose(evidence["likelihood"], expected, rtol=1e-4)


def test_the_evidence_of_the_selection_is_that_of_the_results_where_they_are(evidence):
    path = Path("results") / SELECTION
    if not path.exists() or read_study(Path("results")) != load(Path("config/config.yaml")):
        pytest.skip("`make readings` has not been run here")
    found = pd.read_parquet(path)
    np.testing.assert_allclose(found["likelihood"], evidence["likelihood"], rtol=1e-4)
    assert found["p11_successes"].tolist() == evidence["p11_successes"].tolist()
