"""Our own claims: well written, decidable, and bound to their direction."""

import json
from fnmatch import fnmatch
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.made_up import FROM, ONE, OTHER
from upswing.analysis import statistics
from upswing.analysis.verdicts import write_verdicts
from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.study.claims import load_claims
from upswing.study.config import load
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.paths import RUNS


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
    return write_verdicts(Results(folder), load_claims(Path("config/claims.yaml"))).set_index(
        "claim"
    )["verdict"]


def test_in_a_world_where_the_thesis_is_right_every_claim_is_reproduced(tmp_path):
    assert set(world(tmp_path, TRUE)) == {"reproduced"}


@pytest.mark.parametrize("claim", FALSE)
def test_a_claim_that_is_false_is_not_reproduced(tmp_path, monkeypatch, claim):
    if claim == "C16":
        monkeypatch.setattr("upswing.analysis.verdicts.contracts", lambda problem: problem % 2 == 0)
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
    ],
)
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
