"""Which runs a comparison is of: those that count, paired or not, and none in silence."""

import numpy as np
import pytest

from tests.made_up import FROM, ONE, OTHER, THIRD, ZERO, N, made_up, part, share_of
from upswing.analysis.verdicts import judge, write_verdicts
from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.study.claims import Claim
from upswing.study.errors import BadInput
from upswing.study.paths import RUNS


def shuffled(results, folder):
    """The same results with the rows of their table in another order."""
    rows = results.runs.sample(frac=1, random_state=1).drop(columns="cell")
    write_table(folder / RUNS, rows)
    return Results(folder)


def test_runs_of_two_cells_are_not_paired(tmp_path):
    """Run by run the one cell is ahead, by less than runs differ."""
    results = made_up(tmp_path, swing_ups=[np.arange(N) + 0.5, np.arange(N), ZERO])
    asked = part("probability_greater", [ONE, OTHER], measure="swing_ups", **FROM)
    claim = Claim(statement="…", section="…", figure=5, cell=ONE, parts=[asked])
    (before,) = judge(results, "C0", claim)
    assert before.estimate == pytest.approx((N + 1) / (2 * N))
    (after,) = judge(shuffled(results, tmp_path), "C0", claim)
    assert before == after


def test_runs_of_the_same_seed_are_paired_where_a_part_says_so(tmp_path):
    """The one cell is ahead by 0.3 in every run; of runs that diverged in either there is no pair."""
    values = [np.arange(N) + 0.3, np.arange(N), ZERO]
    diverged = [np.where(np.isin(np.arange(N), own), 7.0, np.nan) for own in ([3], [3, 5], [])]
    results = made_up(tmp_path, swing_ups=values, diverged_at=diverged)
    asked = [
        part("difference_of_means", [ONE, OTHER], measure="swing_ups", paired=paired, at_least=0.2, partly=0.1)
        for paired in (True, False)
    ]  # fmt: skip
    claim = Claim(statement="…", section="…", cell=ONE, parts=asked)
    for seen in (results, shuffled(results, tmp_path)):
        pairs, apart = judge(seen, "C0", claim)
        assert (pairs.estimate, pairs.low, pairs.high) == pytest.approx((0.3, 0.3, 0.3))
        assert pairs.n == N - 2
        assert (pairs.verdict, apart.verdict) == ("reproduced", "inconclusive")
        assert apart.n == N - 2
        assert apart.high - apart.low > 5


def test_pairs_are_of_the_seeds_that_both_cells_have(tmp_path):
    """Of the one cell other seeds were run: 30 to 89."""
    results = made_up(tmp_path, swing_ups=[np.arange(N) + 1.0, np.arange(N) + 30.0, ZERO])
    results.runs.loc[results.runs["cell"] == OTHER, "seed"] += 30
    asked = part("difference_of_means", [ONE, OTHER], measure="swing_ups", paired=True, **FROM)
    (row,) = judge(results, "C0", Claim(statement="…", section="…", cell=ONE, parts=[asked]))
    assert (row.estimate, row.low, row.high, row.n) == pytest.approx((1, 1, 1, 30))


def test_identical_runs_are_paired_by_seed_in_whatever_order_they_stand(tmp_path):
    digests = [f"same-{seed}" for seed in range(N)]
    results = made_up(tmp_path, digest=[digests, digests, digests[::-1]])
    asked = [part("share_identical", [ONE, cell], **FROM) for cell in (OTHER, THIRD)]
    claim = Claim(statement="…", section="…", figure=5, cell=ONE, parts=asked)
    for seen in (results, shuffled(results, tmp_path)):
        assert [row.estimate for row in judge(seen, "C0", claim)] == [1.0, 0.0]


def test_runs_that_diverged_count_neither_for_nor_against(tmp_path):
    """Ten of the first cell, all of which had succeeded, and three others of the second."""
    diverged = [np.where(np.arange(N) < k, 7.0, np.nan) for k in (10, 13, 0)]
    results = made_up(tmp_path, swing_ups=[share_of(0.5), ZERO, ZERO], diverged_at=diverged)
    asked = [
        part("share", [ONE], where={"swing_ups": {"at_least": 1}}, **FROM),
        part("location", [ONE], measure="swing_ups", **FROM),
        part("difference_of_means", [ONE, OTHER], measure="swing_ups", **FROM),
        part("share_identical", [ONE, OTHER], **FROM),
        part("ratio_of_sums", [ONE], measure="swing_ups", per="steps", **FROM),
    ]
    rows = judge(results, "C0", Claim(statement="…", section="…", cell=ONE, parts=asked))
    assert [row.n for row in rows] == [N - 10, N - 10, N - 13, N - 13, N - 10]
    assert [row.diverged for row in rows] == [10, 10, 23, 23, 10]
    expected = [20 / 50, 20 / 50, 20 / 50, 0, 20 / 50_000]
    assert [row.estimate for row in rows] == pytest.approx(expected)


def test_of_too_few_runs_nothing_is_said(tmp_path):
    """Thirty are asked for, of those among which a part looks."""
    results = made_up(tmp_path, swing_ups=[share_of(0.5), share_of(0.5), ZERO], falls=[ZERO] * 3)
    where, among = {"falls": {"at_most": 0}}, {"swing_ups": {"at_least": 1}}
    asked = [
        part("share", [ONE], where=where, among=among, fewest=fewest, **FROM) for fewest in (30, 31)
    ]
    rows = judge(results, "C0", Claim(statement="…", section="…", cell=ONE, parts=asked))
    assert [(row.n, row.verdict) for row in rows] == [(30, "reproduced"), (30, "inconclusive")]


def about_the_other():
    asked = part("share", [OTHER], where={"swing_ups": {"at_least": 1}}, **FROM)
    return {"C0": Claim(statement="…", section="…", cell=OTHER, parts=[asked])}


def test_runs_that_are_missing_fail_loudly_with_the_cells_name(tmp_path):
    results = made_up(tmp_path, swing_ups=[ZERO, ZERO, ZERO])
    runs = results.runs.drop(columns="cell")
    write_table(tmp_path / RUNS, runs[~runs["run"].str.startswith(OTHER)])
    with pytest.raises(BadInput, match=rf"{OTHER}: {N} of {N} runs are missing"):
        write_verdicts(Results(tmp_path), about_the_other(), {})


def test_recordings_that_are_gone_fail_loudly_with_the_cells_name(tmp_path):
    results = made_up(tmp_path, swing_ups=[ZERO, ZERO, ZERO])
    for path in (tmp_path / "runs" / OTHER).iterdir():
        path.unlink()
    with pytest.raises(BadInput, match=rf"{OTHER}: {N} of {N} recordings are missing"):
        write_verdicts(results, about_the_other(), {})


def test_runs_without_a_value_are_not_left_out_in_silence(tmp_path):
    results = made_up(tmp_path, swing_ups=[np.where(share_of(0.5) > 0, 1.0, np.nan), ZERO, ZERO])
    asked = part("probability_greater", [ONE, OTHER], measure="swing_ups", **FROM)
    claim = Claim(statement="…", section="…", figure=5, cell=None, parts=[asked])
    with pytest.raises(BadInput, match="swing_ups: some runs have none"):
        judge(results, "C0", claim)
