"""Verdicts on made-up runs whose truth is known, for each kind of comparison."""

import numpy as np
import pandas as pd
import pytest

from tests.made_up import FROM, NOISE, ONE, OTHER, THIRD, UP_TO, ZERO, N, made_up, part, share_of
from upswing.analysis.verdicts import judge, write_verdicts
from upswing.study.claim_parts import weakest
from upswing.study.claims import Claim
from upswing.study.errors import BadInput

# kind, settings, and for each verdict the measures of the three cells that lead to it
CASES = {
    "share": (
        part("share", [ONE], where={"swing_ups": {"at_least": 1}}, **FROM),
        {
            "reproduced": [share_of(1)],
            "partly": [share_of(0.7)],
            "inconclusive": [share_of(0.5)],
            "not reproduced": [share_of(0.2)],
        },
    ),
    "share, an upper threshold": (
        part("share", [ONE], where={"swing_ups": {"at_least": 1}}, **UP_TO),
        {
            "reproduced": [share_of(0.05)],
            "partly": [share_of(0.3)],
            "inconclusive": [share_of(0.5)],
            "not reproduced": [share_of(0.8)],
        },
    ),
    "share_by": (
        part("share_by", [ONE], measure="swing_ups", limit=500, **FROM),
        {
            "reproduced": [np.full(N, 100.0)],
            "partly": [np.where(share_of(0.7) > 0, 100.0, np.nan)],
            "inconclusive": [np.where(share_of(0.5) > 0, 100.0, 900.0)],
            "not reproduced": [np.where(share_of(0.2) > 0, 100.0, np.nan)],
        },
    ),
    "location": (
        part("location", [ONE], measure="swing_ups", statistic="median", **FROM),
        {
            "reproduced": [0.95 + NOISE],
            "partly": [0.65 + NOISE],
            "inconclusive": [0.5 + NOISE],
            "not reproduced": [0.2 + NOISE],
        },
    ),
    "ratio_of_means": (
        part("ratio_of_means", [ONE, OTHER], measure="swing_ups", **UP_TO),
        {
            "reproduced": [0.1 + NOISE / 10, 1 + NOISE],
            "partly": [0.35 + NOISE / 10, 1 + NOISE],
            "inconclusive": [0.5 + NOISE, 1 - NOISE],
            "not reproduced": [0.9 + NOISE, 1 + NOISE],
        },
    ),
    "ratio_of_sums": (  # of 1,000 steps
        part("ratio_of_sums", [ONE], measure="swing_ups", per="steps", **FROM),
        {
            "reproduced": [950 + 1_000 * NOISE],
            "partly": [650 + 1_000 * NOISE],
            "inconclusive": [500 + 1_000 * NOISE],
            "not reproduced": [200 + 1_000 * NOISE],
        },
    ),
    "difference_of_means": (
        part("difference_of_means", [ONE, OTHER], measure="swing_ups", **FROM),
        {
            "reproduced": [0.95 + NOISE, NOISE[::-1]],
            "partly": [0.65 + NOISE, NOISE[::-1]],
            "inconclusive": [0.5 + NOISE, NOISE[::-1]],
            "not reproduced": [0.2 + NOISE, NOISE[::-1]],
        },
    ),
    "difference_of_shares": (
        part("difference_of_shares", [ONE, OTHER], where={"swing_ups": {"at_least": 1}}, **FROM),
        {
            "reproduced": [share_of(1), share_of(0)],
            "partly": [share_of(0.8), share_of(0.1)],
            "inconclusive": [share_of(0.6), share_of(0.1)],
            "not reproduced": [share_of(0.3), share_of(0.1)],
        },
    ),
    "probability_greater": (
        part("probability_greater", [ONE, OTHER], measure="swing_ups", **FROM),
        {
            "reproduced": [share_of(1), ZERO],
            "partly": [share_of(0.7) - 0.5, ZERO],
            "inconclusive": [share_of(0.5) - 0.5, ZERO],
            "not reproduced": [share_of(0.2) - 0.5, ZERO],
        },
    ),
    "range_of_shares": (
        part("range_of_shares", [ONE, OTHER, THIRD], where={"swing_ups": {"at_least": 1}}, **FROM),
        {
            "reproduced": [share_of(1), share_of(0), share_of(0.5)],
            "partly": [share_of(0.9), share_of(0.1), share_of(0.5)],
            "inconclusive": [share_of(0.6), share_of(0.1), share_of(0.3)],
            "not reproduced": [share_of(0.2), share_of(0.1), share_of(0.15)],
        },
    ),
    "range_of_means": (
        part("range_of_means", [ONE, OTHER, THIRD], measure="swing_ups", **UP_TO),
        {
            "reproduced": [0.1 + NOISE, NOISE, 0.05 - NOISE],
            "partly": [0.35 + NOISE, NOISE, 0.1 - NOISE],
            "inconclusive": [0.5 + NOISE, NOISE[::-1], 0.1 + NOISE],
            "not reproduced": [0.9 + NOISE, NOISE, 0.1 - NOISE],
        },
    ),
}
DIGESTS = {"reproduced": 1.0, "partly": 0.7, "inconclusive": 0.5, "not reproduced": 0.2}


@pytest.mark.parametrize("verdict", ["reproduced", "partly", "inconclusive", "not reproduced"])
@pytest.mark.parametrize("kind", CASES)
def test_each_verdict_of_each_kind_of_comparison(tmp_path, kind, verdict):
    asked, measures = CASES[kind]
    columns = [*measures[verdict], ZERO, ZERO][:3]
    results = made_up(tmp_path, swing_ups=columns)
    claim = Claim(statement="…", section="…", figure=5, cell=ONE, parts=[asked])
    (row,) = judge(results, "C0", claim)
    assert row.verdict == verdict, (row.estimate, row.low, row.high)
    assert row.n == N
    assert row.low <= row.estimate <= row.high
    assert not row.diverged
    lines = {"reproduced": False, "inconclusive": True, "not reproduced": False}
    assert row.at_threshold == lines.get(verdict, row.could_be_better)


@pytest.mark.parametrize("verdict", DIGESTS)
def test_each_verdict_of_identical_runs(tmp_path, verdict):
    one = [f"same-{seed}" for seed in range(N)]
    other = [
        f"same-{seed}" if same else "else" for seed, same in enumerate(share_of(DIGESTS[verdict]))
    ]
    results = made_up(tmp_path, digest=[one, other, one])
    asked = part("share_identical", [ONE, OTHER], **FROM)
    claim = Claim(statement="…", section="…", figure=5, cell=ONE, parts=[asked])
    assert judge(results, "C0", claim)[0].verdict == verdict


@pytest.mark.parametrize("verdict", DIGESTS)
def test_each_verdict_of_what_tiles_can_represent(tmp_path, verdict):
    """Of the starts, whichever cells the study has."""
    results = made_up(tmp_path)
    success = share_of(DIGESTS[verdict]) > 0
    results.__dict__["tile_policy"] = pd.DataFrame({"angle": 0.0, "success": success})
    claim = Claim(statement="…", section="…", parts=[part("share_represented", [], **FROM)])
    (row,) = judge(results, "C0", claim)
    assert (row.verdict, row.estimate, row.n) == (verdict, success.mean(), N)
    assert row.diverged == 0


def test_a_claim_is_as_good_as_its_weakest_part():
    assert weakest(["reproduced", "partly", "reproduced"]) == "partly"
    assert weakest(["reproduced", "inconclusive", "partly"]) == "inconclusive"
    assert weakest(["not reproduced", "inconclusive"]) == "not reproduced"


def test_the_row_of_a_claim_is_that_of_its_decisive_part(tmp_path):
    results = made_up(tmp_path, swing_ups=[share_of(1), share_of(0.2), share_of(0.3)])
    parts = [
        part("share", [cell], where={"swing_ups": {"at_least": 1}}, **FROM)
        for cell in (ONE, OTHER, THIRD)
    ]
    claims = {"C0": Claim(statement="…", section="…", figure=5, cell=ONE, parts=parts)}
    (row,) = write_verdicts(results, claims, {}).to_dict("records")
    assert row["verdict"] == "not reproduced"
    assert row["cells"] == OTHER
    assert row["estimate"] == 0.2
    assert row["parts"] == 3
    # By falls, of which seed 0 has the fewest: the worst, the median and the best run.
    assert [path.split("-")[-1] for path in row["recordings"]] == ["59.rrd", "30.rrd", "0.rrd"]


def test_a_cell_that_the_study_has_not_is_named(tmp_path):
    results = made_up(tmp_path, swing_ups=[ZERO, ZERO, ZERO])
    asked = part(
        "share", ["balancing/table/alpha-0.7"], where={"swing_ups": {"at_least": 1}}, **FROM
    )
    claim = Claim(statement="…", section="…", figure=5, cell=None, parts=[asked])
    (row,) = judge(results, "C0", claim)
    assert row.verdict == "not in this study"
    assert "balancing/table/alpha-0.7" in row.says


def test_partly_says_whether_it_may_be_more(tmp_path):
    results = made_up(tmp_path, swing_ups=[share_of(0.75), share_of(0.65), ZERO])
    parts = [
        part("share", [cell], where={"swing_ups": {"at_least": 1}}, **FROM) for cell in (ONE, OTHER)
    ]
    claim = Claim(statement="…", section="…", figure=5, cell=None, parts=parts)
    rows = judge(results, "C0", claim)
    assert [(row.verdict, row.could_be_better) for row in rows] == [
        ("partly", True),
        ("partly", False),
    ]


def test_a_measure_that_a_table_lacks_is_named(tmp_path):
    results = made_up(tmp_path, swing_ups=[ZERO, ZERO, ZERO])
    asked = part("location", [ONE], measure="arrival_speed", **FROM)
    claim = Claim(statement="…", section="…", figure=5, cell=None, parts=[asked])
    with pytest.raises(BadInput, match="arrival_speed: no measure of a run"):
        judge(results, "C0", claim)
