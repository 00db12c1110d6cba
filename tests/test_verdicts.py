"""Verdicts on made-up runs whose truth is known, for each kind of comparison."""

import json
from fnmatch import fnmatch
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from upswing import statistics
from upswing.claims import Claim, Part, load_claims, weakest
from upswing.cli import main
from upswing.compare import compare
from upswing.config import load, validated
from upswing.matrix import Matrix
from upswing.problems import BadInput
from upswing.runs import Results
from upswing.study import canonical, write_study
from upswing.tables import RUNS, write_table
from upswing.verdicts import judge, write_verdicts

ONE, OTHER, THIRD = (f"balancing/table/alpha-{alpha}" for alpha in ("1", "0.5", "0.1"))
N = 60
STUDY = {
    "seeds": N,
    "tasks": {"balancing": {"kind": "balancing", "steps": 1_000}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1, 0.5, 0.1]}],
}


def made_up(folder, **columns):
    """A folder of results with made-up measures: of each column three arrays, one for each cell."""
    study = validated({"study": STUDY})
    write_study(canonical(study), folder)
    frames = []
    for number, cell in enumerate((ONE, OTHER, THIRD)):
        frame = pd.DataFrame({"seed": range(N)})
        frame["run"] = [f"{cell}/seed-{seed}" for seed in range(N)]
        frame["recording"] = [f"runs/{cell}/seed-{seed}.rrd" for seed in range(N)]
        frame["steps"], frame["falls"], frame["falls_last_fifth"] = 1_000, range(N), 0
        frame["digest"] = [f"{number}-{seed}" for seed in range(N)]
        for name, values in columns.items():
            frame[name] = values[number]
        frames.append(frame)
    runs = pd.concat(frames, ignore_index=True)
    write_table(folder / RUNS, runs)
    for recording in runs["recording"]:
        (folder / recording).parent.mkdir(parents=True, exist_ok=True)
        (folder / recording).touch()
    return Results(folder)


def part(kind, cells, **settings):
    return Part.model_validate(
        {"says": "…", "because": "…", "kind": kind, "cells": list(cells), **settings}
    )


def share_of(value):
    """N numbers, of which a share is 1 and the rest 0."""
    return (np.arange(N) < round(value * N)).astype(float)


rng = np.random.default_rng(0)
NOISE = rng.normal(0, 0.05, N)
ZERO = np.zeros(N)
FROM = {"at_least": 0.8, "partly": 0.5}
UP_TO = {"at_most": 0.2, "partly": 0.5}

# kind, settings, and for each verdict the measures of the three cells that lead to it
CASES = {
    "share": (
        part("share", [ONE], where={"x": {"at_least": 1}}, **FROM),
        {
            "reproduced": [share_of(1)],
            "partly": [share_of(0.7)],
            "inconclusive": [share_of(0.5)],
            "not reproduced": [share_of(0.2)],
        },
    ),
    "share, an upper threshold": (
        part("share", [ONE], where={"x": {"at_least": 1}}, **UP_TO),
        {
            "reproduced": [share_of(0.05)],
            "partly": [share_of(0.3)],
            "inconclusive": [share_of(0.5)],
            "not reproduced": [share_of(0.8)],
        },
    ),
    "share_by": (
        part("share_by", [ONE], measure="x", limit=500, **FROM),
        {
            "reproduced": [np.full(N, 100.0)],
            "partly": [np.where(share_of(0.7) > 0, 100.0, np.nan)],
            "inconclusive": [np.where(share_of(0.5) > 0, 100.0, 900.0)],
            "not reproduced": [np.where(share_of(0.2) > 0, 100.0, np.nan)],
        },
    ),
    "location": (
        part("location", [ONE], measure="x", statistic="median", **FROM),
        {
            "reproduced": [0.95 + NOISE],
            "partly": [0.65 + NOISE],
            "inconclusive": [0.5 + NOISE],
            "not reproduced": [0.2 + NOISE],
        },
    ),
    "ratio_of_means": (
        part("ratio_of_means", [ONE, OTHER], measure="x", **UP_TO),
        {
            "reproduced": [0.1 + NOISE / 10, 1 + NOISE],
            "partly": [0.35 + NOISE / 10, 1 + NOISE],
            "inconclusive": [0.5 + NOISE, 1 - NOISE],
            "not reproduced": [0.9 + NOISE, 1 + NOISE],
        },
    ),
    "difference_of_means": (
        part("difference_of_means", [ONE, OTHER], measure="x", **FROM),
        {
            "reproduced": [0.95 + NOISE, NOISE[::-1]],
            "partly": [0.65 + NOISE, NOISE[::-1]],
            "inconclusive": [0.5 + NOISE, NOISE[::-1]],
            "not reproduced": [0.2 + NOISE, NOISE[::-1]],
        },
    ),
    "difference_of_shares": (
        part("difference_of_shares", [ONE, OTHER], where={"x": {"at_least": 1}}, **FROM),
        {
            "reproduced": [share_of(1), share_of(0)],
            "partly": [share_of(0.8), share_of(0.1)],
            "inconclusive": [share_of(0.6), share_of(0.1)],
            "not reproduced": [share_of(0.3), share_of(0.1)],
        },
    ),
    "probability_greater": (
        part("probability_greater", [ONE, OTHER], measure="x", **FROM),
        {
            "reproduced": [share_of(1), ZERO],
            "partly": [share_of(0.7) - 0.5, ZERO],
            "inconclusive": [share_of(0.5) - 0.5, ZERO],
            "not reproduced": [share_of(0.2) - 0.5, ZERO],
        },
    ),
    "range_of_shares": (
        part("range_of_shares", [ONE, OTHER, THIRD], where={"x": {"at_least": 1}}, **FROM),
        {
            "reproduced": [share_of(1), share_of(0), share_of(0.5)],
            "partly": [share_of(0.9), share_of(0.1), share_of(0.5)],
            "inconclusive": [share_of(0.6), share_of(0.1), share_of(0.3)],
            "not reproduced": [share_of(0.2), share_of(0.1), share_of(0.15)],
        },
    ),
    "range_of_means": (
        part("range_of_means", [ONE, OTHER, THIRD], measure="x", **UP_TO),
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
    results = made_up(tmp_path, x=columns)
    claim = Claim(statement="…", section="…", figure=5, cell=ONE, parts=[asked])
    (row,) = judge(results, "C0", claim)
    assert row.verdict == verdict, (row.estimate, row.low, row.high)
    assert row.n == N
    assert row.low <= row.estimate <= row.high
    # A claim far beyond its threshold is unlikely by chance; short of it, it is not.
    assert (row.p_value < 0.05) == (verdict == "reproduced")


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


def test_runs_are_paired_by_seed_in_whatever_order_they_stand(tmp_path):
    results = made_up(tmp_path, x=[np.arange(N) + 0.5, np.arange(N), ZERO])
    asked = part("probability_greater", [ONE, OTHER], measure="x", **FROM)
    claim = Claim(statement="…", section="…", figure=5, cell=ONE, parts=[asked])
    (before,) = judge(results, "C0", claim)
    shuffled = results.runs.sample(frac=1, random_state=1).drop(columns="cell")
    write_table(tmp_path / RUNS, shuffled)
    (after,) = judge(Results(tmp_path), "C0", claim)
    assert before[:9] == after[:9]
    assert before.estimate == 1


def test_a_claim_is_as_good_as_its_weakest_part():
    assert weakest(["reproduced", "partly", "reproduced"]) == "partly"
    assert weakest(["reproduced", "inconclusive", "partly"]) == "inconclusive"
    assert weakest(["not reproduced", "inconclusive"]) == "not reproduced"


def test_the_row_of_a_claim_is_that_of_its_decisive_part(tmp_path):
    results = made_up(tmp_path, x=[share_of(1), share_of(0.2), share_of(0.3)])
    parts = [
        part("share", [cell], where={"x": {"at_least": 1}}, **FROM) for cell in (ONE, OTHER, THIRD)
    ]
    claims = {"C0": Claim(statement="…", section="…", figure=5, cell=ONE, parts=parts)}
    (row,) = write_verdicts(results.folder, claims).to_dict("records")
    assert row["verdict"] == "not reproduced"
    assert row["cells"] == OTHER
    assert row["estimate"] == 0.2
    assert row["parts"] == 3
    # By falls, of which seed 0 has the fewest: the worst, the median and the best run.
    assert [path.split("-")[-1] for path in row["recordings"]] == ["59.rrd", "30.rrd", "0.rrd"]


def test_a_cell_that_the_study_has_not_is_named(tmp_path):
    results = made_up(tmp_path, x=[ZERO, ZERO, ZERO])
    asked = part("share", ["balancing/table/alpha-0.7"], where={"x": {"at_least": 1}}, **FROM)
    claim = Claim(statement="…", section="…", figure=5, cell=None, parts=[asked])
    (row,) = judge(results, "C0", claim)
    assert row.verdict == "not in this study"
    assert "balancing/table/alpha-0.7" in row.says


def test_runs_that_are_missing_fail_loudly_with_the_cells_name(tmp_path):
    results = made_up(tmp_path, x=[ZERO, ZERO, ZERO])
    runs = results.runs.drop(columns="cell")
    write_table(tmp_path / RUNS, runs[~runs["run"].str.startswith(OTHER)])
    with pytest.raises(BadInput, match=rf"{OTHER}: {N} of {N} runs are missing"):
        write_verdicts(tmp_path, {})


def test_recordings_that_are_gone_fail_loudly_with_the_cells_name(tmp_path):
    results = made_up(tmp_path, x=[ZERO, ZERO, ZERO])
    for path in (tmp_path / "runs" / OTHER).iterdir():
        path.unlink()
    with pytest.raises(BadInput, match=rf"{OTHER}: {N} of {N} recordings are missing"):
        write_verdicts(results.folder, {})


def test_runs_without_a_value_are_not_paired_in_silence(tmp_path):
    results = made_up(tmp_path, x=[np.where(share_of(0.5) > 0, 1.0, np.nan), ZERO, ZERO])
    asked = part("probability_greater", [ONE, OTHER], measure="x", **FROM)
    claim = Claim(statement="…", section="…", figure=5, cell=None, parts=[asked])
    with pytest.raises(BadInput, match="x: some runs have none"):
        judge(results, "C0", claim)


def test_partly_says_whether_it_may_be_more(tmp_path):
    results = made_up(tmp_path, x=[share_of(0.75), share_of(0.65), ZERO])
    parts = [part("share", [cell], where={"x": {"at_least": 1}}, **FROM) for cell in (ONE, OTHER)]
    claim = Claim(statement="…", section="…", figure=5, cell=None, parts=parts)
    rows = judge(results, "C0", claim)
    assert [(row.verdict, row.could_be_better) for row in rows] == [
        ("partly", True),
        ("partly", False),
    ]


def test_a_measure_that_is_none_is_named(tmp_path):
    results = made_up(tmp_path, x=[ZERO, ZERO, ZERO])
    asked = part("location", [ONE], measure="falls_last_fith", **FROM)
    claim = Claim(statement="…", section="…", figure=5, cell=None, parts=[asked])
    with pytest.raises(BadInput, match="did you mean 'falls_last_fifth'"):
        judge(results, "C0", claim)


# Our own claims.


def test_there_are_sixteen_claims_and_the_study_has_all_their_cells():
    claims = load_claims(Path("config/claims.yaml"))
    assert list(claims) == [f"C{number}" for number in range(1, 17)]
    for config in ("config/config.yaml", "config/smoke.yaml"):
        cells = Matrix(load(Path(config))).cells
        for claim in claims.values():
            assert claim.cell is None or claim.cell in cells
            for asked in claim.parts:
                assert {cell for cells_ in asked.comparisons for cell in cells_} <= set(cells)
                for key in asked.only_if:
                    assert hasattr(next(iter(cells.values())).readings, key)


def test_thirty_runs_can_reach_both_ends_of_every_share():
    """No verdict may be out of reach whatever comes out."""
    for name, claim in load_claims(Path("config/claims.yaml")).items():
        for asked in claim.parts:
            if asked.kind in ("share", "share_by", "share_identical", "share_contracting"):
                n = 300 if asked.kind == "share_contracting" else 30
                reached = {asked.verdict(statistics.share(k, n)) for k in range(n + 1)}
                assert {"reproduced", "not reproduced"} <= reached, (name, asked.says)


# For each claim measures of cells, by pattern, under which it is true, and under which it is false.
# Of several patterns the last that matches counts. Two numbers are the bounds of random values.
BALANCES, FALLS = {"falls_last_fifth": 0}, {"falls_last_fifth": 30}
SOLVED, FAILED = {"upright_share": 0.97}, {"upright_share": (0.0, 0.1)}
TRUE = {
    "*": {**FAILED, "falls_last_fifth": 30, "falls_first_5000": 50, "falls_2500_to_5000": 30,
          "mean_reward": (-8.6, -8.4), "greedy_success_share": 0, "first_stable_step": np.nan,
          "too_fast_share": 0.6, "recovered_share": 0.9},
    "balancing/random/*": {"falls_2500_to_5000": 30, "falls_last_fifth": 100},
    "full-control/idle/*": {"mean_reward": -9.87},
    "balancing/table/*": {"falls_2500_to_5000": 3, "falls_first_5000": 10},
    "balancing/table/alpha-0*": BALANCES,
    "balancing/networks-5/*": {**BALANCES, "first_stable_step": 9_000, "falls_first_5000": 60},
    "full-control/modular-networks-5/*": {"upright_share": "three in ten"},
}  # fmt: skip
FALSE = {
    "C1": {"balancing/table/alpha-1": {"falls_2500_to_5000": 29}},
    "C2": {"balancing/table/alpha-1": BALANCES},
    "C3": {"balancing/table/alpha-0.001": FALLS},
    "C4": {"balancing/networks-5/alpha-1": {"falls_first_5000": 5}},
    "C5": {"balancing/networks-5/alpha-1": FALLS},
    "C6": {"balancing/table/*": BALANCES},
    "C7": {"full-control/table/alpha-0.001": {"mean_reward": -1.0}},
    "C8": {"full-control/table/alpha-0.5": SOLVED},
    "C9": {"full-control-long/table/*": SOLVED},
    "C10": {"full-control/networks-20-5/*": {"mean_reward": -2.0}},
    "C11": {"full-control/modular-table/alpha-0.1": SOLVED},
    "C12": {"full-control/modular-networks-5/*": FAILED},
    "C13": {"full-control/modular-networks-5/*": SOLVED},
    "C14": {"full-control/modular-networks-5/*": {"recovered_share": 0.1}},
    "C15": {"full-control/modular-networks-5/*": {"too_fast_share": 0.02}},
    "C16": {},
}


def world(folder, *layers):
    """Results of the thesis's own matrix with made-up measures."""
    study = load(Path("config/config.yaml"))
    write_study(canonical(study), folder)
    rows, draws = [], np.random.default_rng(1)
    for cell, spec in Matrix(study).cells.items():
        measures = {}
        for layer in layers:
            for pattern, values in layer.items():
                if fnmatch(cell, pattern):
                    measures.update(values)
        twin = cell.replace("modular-table", "table")  # R14: the same runs
        for seed in spec.seeds:
            row = {"run": spec.run(seed), "seed": seed, "steps": spec.task.steps, "falls": seed}
            row |= {"recording": f"runs/{spec.run(seed)}.rrd", "digest": f"{twin}-{seed}"}
            for name, value in measures.items():
                if isinstance(value, tuple):
                    value = draws.uniform(*value)
                elif value == "three in ten":
                    value = 0.97 if seed % 10 < 3 else 0.05
                row[name] = value
            rows.append(row)
            (folder / row["recording"]).parent.mkdir(parents=True, exist_ok=True)
            (folder / row["recording"]).touch()
    write_table(folder / RUNS, pd.DataFrame(rows))
    return write_verdicts(folder, load_claims(Path("config/claims.yaml"))).set_index("claim")[
        "verdict"
    ]


def test_in_a_world_where_the_thesis_is_right_every_claim_is_reproduced(tmp_path):
    assert set(world(tmp_path, TRUE)) == {"reproduced"}


@pytest.mark.parametrize("claim", FALSE)
def test_a_claim_that_is_false_is_not_reproduced(tmp_path, monkeypatch, claim):
    if claim == "C16":
        monkeypatch.setattr("upswing.verdicts.contracts", lambda problem: problem % 2 == 0)
    verdicts = world(tmp_path, TRUE, FALSE[claim])
    assert verdicts[claim] == "not reproduced"


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"partly": 0.9}, "`partly` must be the weaker"),
        ({"at_most": 0.1}, "either `at_least` or `at_most`"),
        ({"where": {}}, "`where` goes with share"),
        ({"measure": "falls"}, "`measure` does not go with share"),
        ({"cells": [ONE, OTHER]}, "share compares 1 to 1 cells, not 2"),
        ({"kind": "shares"}, "did you mean 'share"),
        ({"becuase": "…"}, "unknown key: did you mean 'because'?"),
    ],
)
def test_a_badly_written_claim_is_explained(tmp_path, change, expected):
    good = {"says": "…", "because": "…", "kind": "share", "cells": [ONE], "where": {"x": {"at_least": 1}}, **FROM}  # fmt: skip
    path = tmp_path / "claims.yaml"
    claim = {
        "statement": "…",
        "section": "…",
        "figure": None,
        "cell": None,
        "parts": [{**good, **change}],
    }
    path.write_text(json.dumps({"C1": claim}), "utf-8")
    with pytest.raises(BadInput) as caught:
        load_claims(path)
    assert expected in str(caught.value)
    assert "C1.parts[0]" in str(caught.value)


# Comparing two folders.


@pytest.fixture
def two_folders(tmp_path):
    """Two folders of results that are alike."""
    asked = part("share", [ONE], where={"x": {"at_least": 1}}, **FROM)
    claims = {"C1": Claim(statement="…", section="…", figure=5, cell=ONE, parts=[asked])}

    def make(name, x):
        made_up(tmp_path / name, x=[x, ZERO, ZERO])
        write_verdicts(tmp_path / name, claims)
        return tmp_path / name

    return make


def test_the_same_results_compare_as_the_same(two_folders, capsys):
    a, b = two_folders("a", share_of(1)), two_folders("b", share_of(1))
    found = compare(a, b)
    assert found.common_runs == 3 * N
    assert not any((found.changed_verdicts, found.parted_estimates, found.changed_runs))
    assert main(["compare", str(a), str(b)]) == 0
    assert "every verdict is the same" in capsys.readouterr().out


def test_a_changed_verdict_and_a_changed_run_are_named(two_folders, capsys):
    a, b = two_folders("a", share_of(1)), two_folders("b", share_of(0.2))
    runs = pd.read_parquet(b / RUNS)
    runs.loc[runs["run"] == f"{ONE}/seed-3", "digest"] = "another"
    write_table(b / RUNS, runs)
    found = compare(a, b)
    assert found.changed_verdicts == [("C1", "reproduced", "not reproduced")]
    assert found.changed_runs == [f"{ONE}/seed-3"]
    assert [estimate[2:] for estimate in found.parted_estimates] == [(1.0, 0.2)]
    assert main(["compare", str(a), str(b)]) == 1
    assert "C1: reproduced → not reproduced" in capsys.readouterr().out


def test_a_folder_that_was_never_judged(two_folders, tmp_path, capsys):
    a = two_folders("a", share_of(1))
    assert main(["compare", str(a), str(tmp_path / "none")]) == 2
    assert "verdicts.parquet: missing" in capsys.readouterr().err
