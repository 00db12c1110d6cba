"""Claims judged under every reading of a made-up sweep, whose truth is known."""

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from tests.made_up import FROM, part
from tests.unit.analysis.small_sweeps import STUDY
from tests.unit.analysis.test_weighing import LARGE, MODULAR, REPORTS, SIMPLE, TABLE
from upswing.analysis.posterior import DRAWS
from upswing.analysis.robustness.judging import robustness, summary
from upswing.runs.rows import framed
from upswing.study.claims import Claim
from upswing.study.readings import options_of
from upswing.study.sweeps import Sweep, canonical_of

RATES, SEEDS, BESIDE = options_of("learning_rate"), 40, 60
SMALL = 0.2
"""Below this rate networks do what the author reports; above it they overflow."""

SWEEP = Sweep(
    vary=("learning_rate",), how="grid", seeds=SEEDS, cells=(SIMPLE, MODULAR), beside=(TABLE,),
    seeds_beside=BESIDE, cells_of_rounds=(LARGE,), reports={"p7": REPORTS["p7"], "p11": REPORTS["p11"]},
)  # fmt: skip
FINALISTS = RATES[1:3]
NO_TILES = pd.DataFrame({"success": np.empty(0, dtype=bool)})
ERROR = 3 * 0.5 / np.sqrt(DRAWS)


def rows_of(readings, cell, seeds, won, diverged=0):
    """Runs of a cell under a reading: so many succeed, so many others diverged."""
    return [
        {
            "readings": canonical_of(readings), "cell": cell, "run": f"{cell}/seed-{seed}", "seed": seed,
            "recording": "", "digest": str(seed), "diverged_at": 7 if seed >= seeds - diverged else None,
            "falls": seed, "falls_last_fifth": 0 if seed < won else 3, "falls_first_5000": 20 + seed % 5,
            "upright_at_end": 0.95 if seed < won else 0.1, "upright_share": 0.5, "mean_reward": -1.0,
        }
        for seed in range(seeds)
    ]  # fmt: skip


def swept():
    rows = rows_of({}, TABLE, BESIDE, BESIDE)
    for rate in RATES:
        reading, is_small = {"learning_rate": rate}, rate < SMALL
        rows += rows_of(reading, SIMPLE, SEEDS, 36 if is_small else 0, 0 if is_small else 35)
        rows += rows_of(reading, MODULAR, SEEDS, 20 if is_small else 0, 0 if is_small else 35)
        if rate in FINALISTS:
            rows += rows_of(reading, LARGE, SEEDS, 2)
    return framed(rows)


STANDS, BALANCES = {"upright_at_end": {"at_least": 0.9}}, {"falls_last_fifth": {"at_most": 0}}
CLAIMS = {
    "C1": Claim(statement="networks balance", section="…", cell=SIMPLE,
                parts=[part("share", [SIMPLE], where=BALANCES, **FROM)]),
    "C2": Claim(statement="modular ones can stand", section="…", cell=MODULAR,
                parts=[part("share", [MODULAR], where=STANDS, at_least=0.3, partly=0.1)]),
    "C3": Claim(statement="a table balances as often", section="…", cell=SIMPLE,
                parts=[part("difference_of_shares", [SIMPLE, TABLE], where=BALANCES, at_most=0, partly=0.1)]),
    "C4": Claim(statement="large ones fail", section="…", cell=LARGE,
                parts=[part("share", [LARGE], where=STANDS, at_most=0.2, partly=0.5)]),
    "C5": Claim(statement="about a table", section="…", cell=TABLE,
                parts=[part("share", [TABLE], where=BALANCES, **FROM)]),
}  # fmt: skip


@pytest.fixture(scope="module")
def judged():
    return robustness({"networks": SWEEP}, STUDY, CLAIMS, {"networks": swept()}, NO_TILES)


@pytest.fixture(scope="module")
def robust(judged):
    return summary(judged, {"networks": SWEEP}, CLAIMS, {"networks": swept()}).set_index("claim")


def of(judged, claim):
    own = judged[judged["claim"] == claim]
    return own.set_index(own["learning_rate"].astype(float))


def test_every_reading_is_judged_that_has_a_claims_cells(judged):
    for claim in ("C1", "C2", "C3"):
        assert of(judged, claim).index.tolist() == RATES
    # Of the large ones, run in later rounds, those that went on; of a table none: no reading touches it.
    assert of(judged, "C4").index.tolist() == FINALISTS
    assert of(judged, "C5").empty


@pytest.mark.parametrize(
    ("claim", "small", "large"),
    [("C1", "partly", "not reproduced"), ("C2", "reproduced", "inconclusive")],
)
def test_each_reading_has_the_verdict_of_its_own_runs(judged, claim, small, large):
    """Of 40 runs five stayed finite where the rate is large, and none of these succeeded."""
    found = of(judged, claim)
    assert found["n"].to_dict() == {rate: SEEDS if rate < SMALL else 5 for rate in RATES}
    assert found["verdict"].to_dict() == {rate: small if rate < SMALL else large for rate in RATES}
    assert found["estimate_holds"].to_dict() == {rate: rate < SMALL for rate in RATES}


def test_the_default_is_the_studys_own_reading(judged):
    own = judged[judged["is_default"]]
    assert set(own["learning_rate"].astype(float)) == {STUDY.readings.learning_rate}
    assert own["claim"].tolist() == ["C1", "C2", "C3"]


def test_how_probable_a_claim_is_under_a_reading_is_said_by_its_finite_runs(judged):
    found = of(judged, "C1")["probability"]
    for rate in RATES:
        won, lost = (36, 4) if rate < SMALL else (0, 5)
        expected = stats.beta(won + 0.5, lost + 0.5).sf(0.8)
        assert found[rate] == pytest.approx(expected, abs=ERROR)


def test_what_no_reading_touches_stands_beside_each(judged):
    """60 of 60 tables balance, run once; they are compared with the networks of every reading."""
    found = of(judged, "C3")
    assert found.loc[RATES[0], "estimate"] == pytest.approx(36 / 40 - 1)
    assert found.loc[1.0, "estimate"] == pytest.approx(-1)
    assert (found["estimate_holds"]).all()


def test_a_claim_holds_over_readings_as_far_as_the_others_reports_speak_for_it(robust):
    """Only small rates are left of either, by the report about the other's cell."""
    small = sum(rate < SMALL for rate in RATES)
    for claim, left_out, (won, lost), line in (
        ("C1", "p7", (36, 4), 0.8),
        ("C2", "p11", (20, 20), 0.3),
    ):
        row = robust.loc[claim]
        assert (row["readings"], row["estimate_holds"]) == (len(RATES), small)
        assert row["left_out"] == left_out
        likely = stats.beta(won + 0.5, lost + 0.5).sf(line)
        assert row["weighted_share"] == pytest.approx(likely, abs=0.02)
        assert row["weighted_low"] <= row["weighted_share"] <= row["weighted_high"]
        assert row["held_share"] == pytest.approx(small / len(RATES))
    assert robust.at["C2", "grade"] == "holds"


def test_unweighed_it_would_depend_on_the_reading(judged):
    """The same claims, had the author reported nothing."""
    silent = SWEEP.model_copy(update={"reports": {}})
    found = summary(judged, {"networks": silent}, CLAIMS, {"networks": swept()}).set_index("claim")
    mean = of(judged, "C2")["probability"].mean()
    assert found.at["C2", "weighted_share"] == pytest.approx(mean)
    assert found.at["C2", "grade"] == "depends on the reading"


def test_claims_stand_in_the_order_of_their_numbers(judged):
    renamed = judged.replace({"claim": {"C1": "C10"}})
    claims = {**CLAIMS, "C10": CLAIMS["C1"]}
    found = summary(renamed, {"networks": SWEEP}, claims, {"networks": swept()})
    assert found["claim"].tolist() == ["C2", "C3", "C4", "C10"]
