"""Our own claims: well written, decidable, and bound to their direction."""

import json
from fnmatch import fnmatch
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.made_up import FROM, ONE, OTHER
from upswing.analysis.contraction import PROBLEMS
from upswing.analysis.verdicts import evidence_of, judge_all, verdicts_by
from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.runs.rows import framed
from upswing.runs.study_file import canonical, write_study
from upswing.study.claims import load_claims
from upswing.study.config import load
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.paths import RUNS, TILES
from upswing.study.task import kind_of_task

CLAIMS = load_claims(Path("config/claims.yaml"))
PARTS = [
    (name, number, part)
    for name, claim in CLAIMS.items()
    for number, part in enumerate(claim.parts, 1)
]


def test_there_are_sixteen_claims_and_the_study_has_all_their_cells():
    assert list(CLAIMS) == [f"C{number}" for number in range(1, 17)]
    for config in ("config/config.yaml", "config/smoke.yaml"):
        cells = Matrix(load(Path(config))).cells
        for claim in CLAIMS.values():
            assert claim.cell is None or claim.cell in cells
            for asked in claim.parts:
                assert {cell for cells_ in asked.comparisons for cell in cells_} <= set(cells)
                for key in asked.only_if:
                    assert hasattr(next(iter(cells.values())).readings, key)


# Measures of cells, by pattern, under which every claim is true, and for each part of each claim under
# which it is false. Of several patterns the last that matches counts. Two numbers are the bounds of random
# values; `TILES` stands for the starts from which a policy on the tiles succeeds.
TABLE, NETWORKS = "balancing/table/alpha-1", "balancing/networks-5/alpha-1"
MODULAR = "full-control/modular-networks-5/*"
BALANCES, FALLS = {"falls_last_fifth": 0}, {"falls_last_fifth": 30}
SOLVED = {"upright_share": 0.97, "upright_at_end": 0.97}
FAILED = {"upright_share": (0.0, 0.1), "upright_at_end": (0.0, 0.1)}
TRUE = {
    "*": {**FAILED, "falls_last_fifth": 30, "falls_first_5000": 50, "falls_2500_to_5000": 30,
          "mean_reward": (-8.6, -8.4), "first_stable_step": np.nan, "recovered_share": 0.9,
          "swing_ups_last_fifth": 10, "too_fast_last_fifth": 6, "diverged_at": np.nan},
    "balancing/random/*": {"falls_2500_to_5000": 30, "falls_last_fifth": 100},
    "full-control/idle/*": {"mean_reward": -9.87},
    "balancing/table/*": {"falls_2500_to_5000": 3, "falls_first_5000": 10},
    "balancing/table/alpha-0*": BALANCES,
    "balancing/networks-5/*": {**BALANCES, "first_stable_step": 9_000, "falls_first_5000": 60},
    MODULAR: {"upright_at_end": "three in ten"},
    TILES: {"success": False},
}  # fmt: skip
FALSE = {
    ("C1", 1): {TABLE: {"falls_2500_to_5000": 29}},
    ("C2", 1): {TABLE: BALANCES},
    ("C3", 1): {"balancing/table/alpha-0.001": FALLS},
    ("C3", 2): {TABLE: {"falls_last_fifth": 1}, "balancing/table/alpha-0.001": FALLS},
    ("C4", 1): {NETWORKS: {"falls_first_5000": 5}},
    ("C4", 2): {NETWORKS: {"falls_last_fifth": (95, 99)}},
    ("C5", 1): {NETWORKS: FALLS},
    ("C6", 1): {"balancing/table/*": BALANCES},
    ("C6", 2): {NETWORKS: FALLS},
    ("C7", 1): {"full-control/table/alpha-0.001": SOLVED},
    ("C7", 2): {"full-control/table/alpha-0.001": {"mean_reward": (-12, -11)}},
    ("C7", 3): {"full-control/table/alpha-0.001": {"mean_reward": -1.0}},
    ("C8", 1): {"full-control/table/alpha-0.5": SOLVED},
    ("C9", 1): {"full-control-long/table/*": SOLVED},
    ("C9", 2): {TILES: {"success": True}},
    ("C10", 1): {"full-control/networks-20-5/*": SOLVED},
    ("C10", 2): {"full-control/networks-20-5/*": {"mean_reward": -2.0}},
    ("C11", 1): {"full-control/modular-table/alpha-0.1": SOLVED},
    ("C11", 2): {"full-control/modular-table/alpha-0.001": {"digest": "another"}},
    ("C12", 1): {MODULAR: FAILED},
    ("C13", 1): {MODULAR: SOLVED},
    ("C14", 1): {MODULAR: {"recovered_share": 0.1}},
    ("C15", 1): {MODULAR: {"too_fast_last_fifth": 0}},
    ("C16", 1): {},
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
    write_table(folder / RUNS, framed(rows))
    tiles = {name: value for layer in layers for name, value in layer.get(TILES, {}).items()}
    starts = kind_of_task("full-control").greedy_starts
    write_table(folder / TILES, pd.DataFrame({"angle": starts, **tiles}))
    return Results(folder)


@pytest.fixture(scope="module")
def right(tmp_path_factory):
    """The verdicts and the evidence in a world where the thesis is right."""
    return judge_all(world(tmp_path_factory.mktemp("right"), TRUE), CLAIMS, {})


def test_in_a_world_where_the_thesis_is_right_every_claim_is_reproduced(right):
    verdicts, evidence = right
    assert set(verdicts["verdict"]) == {"reproduced"}
    assert not verdicts["fragile"].any()
    assert len(evidence) == sum(len(part.comparisons) for _, _, part in PARTS)


def test_for_every_part_of_every_claim_it_is_known_when_it_is_false():
    assert list(FALSE) == [(name, number) for name, number, _ in PARTS]


@pytest.mark.parametrize(("claim", "part"), FALSE)
def test_a_claim_that_is_false_is_not_reproduced(tmp_path, monkeypatch, claim, part):
    if claim == "C16":
        half = PROBLEMS // 2
        monkeypatch.setattr("upswing.analysis.comparisons._contracting", lambda: (half, PROBLEMS))
    results, asked = world(tmp_path, TRUE, FALSE[claim, part]), {claim: CLAIMS[claim]}
    evidence = evidence_of(results, asked)
    assert verdicts_by(asked, evidence) == {claim: "not reproduced"}
    assert "not reproduced" in {row.verdict for row in evidence if row.part == part}


def test_what_is_true_by_construction_is_said_to_be_no_evidence(right):
    verdicts = right[0].set_index("claim")
    assert verdicts["check"].to_dict() == {name: claim.check for name, claim in CLAIMS.items()}
    assert set(verdicts.index[verdicts["check"] != ""]) == {"C11", "C16"}


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
        ({"where": {"fals": {"at_least": 1}}}, "no measure of a run; did you mean 'falls'?"),
        ({"where": {"falls": {}}}, "write `at_least`, `at_most` or `below`"),
        ({"at_least": 7}, "the thresholds of share lie between 0 and 1"),
        ({"cells": ["balancing/table/alpha-0.10"]}, "α is written shortest: alpha-0.1"),
        ({"cells": ["../../table/alpha-1"]}, "a cell is task/architecture/alpha-α"),
        ({"cells": [], "each": [ONE], "each_pair": [[ONE, OTHER]]}, "write one of `cells`"),
        ({"only_if": {"tiles": "first"}}, '"tiles": no such reading'),
        ({"only_if": {"ties": "last"}}, '"last": no such option; there are random, first'),
        ({"cells": {}}, "must be a list"),
        ({"partly": "0.5"}, "this is text, not a number; write 0.5"),
        ({"per": "steps"}, "`per` goes with ratio_of_sums, always"),
        ({"kind": "ratio_of_sums", "where": {}, "measure": "falls"}, "`per` goes with ratio_of_sums, always"),
        ({"kind": "ratio_of_sums", "where": {}, "measure": "falls", "per": "stepps"}, "no measure of a run; did you mean 'steps'?"),
        ({"kind": "share_represented", "where": {}}, "share_represented compares 0 to 0 cells, not 1"),
        ({"where": {"upright_at_end": {"at_least": 90}}}, "upright_at_end lies between 0 and 1"),
        ({"fewest": 0}, "fewest: 0: "),
        ({"paired": True}, "`paired` goes with difference_of_means"),
    ],
)  # fmt: skip
def test_a_badly_written_claim_is_explained(tmp_path, change, expected):
    good = {"says": "…", "because": "…", "kind": "share", "cells": [ONE], "where": {"falls": {"at_least": 1}}, **FROM}  # fmt: skip
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
