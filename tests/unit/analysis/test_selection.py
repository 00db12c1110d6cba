"""The rule that selects the networks' default reading, and its evidence."""

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from upswing.analysis.robustness.selection import CELLS, select
from upswing.runs.study_file import read_study
from upswing.study.config import load
from upswing.study.paths import SELECTION
from upswing.study.readings import Readings


def successes(readings, k7, k9, k11, n=20):
    rows = []
    for (name, cell), k in zip(CELLS.items(), (k7, k9, k11), strict=True):
        task = cell.split("/")[0]
        for seed in range(n):
            won = seed < k
            rows.append(
                {
                    "readings": json.dumps(readings), "cell": cell, "task": task, "seed": seed,
                    "falls_last_fifth": 0 if won or task != "balancing" else 3,
                    "upright_share": 0.95 if won or task == "balancing" else 0.5, "name": name,
                }
            )  # fmt: skip
    return pd.DataFrame(rows)


def test_the_likelihood_is_that_of_the_ledger():
    runs = pd.concat(
        [
            successes({"biases": "both"}, 20, 20, 10),
            successes({"biases": "none"}, 19, 0, 9),
            successes({"biases": "hidden"}, 19, 0, 9),
        ]
    )
    chosen = select(runs)
    p7, p9, p11 = 20 / 22, 1 / 22, 10 / 22
    assert chosen["biases"].tolist() == ["none", "hidden", "both"]  # equal ones in their order
    assert chosen.at[0, "likelihood"] == pytest.approx(p7 * (1 - p9) * p11 * (1 - p11))
    assert chosen.at[2, "likelihood"] == pytest.approx(21 / 22 * (1 / 22) * (11 / 22) ** 2)
    assert chosen.loc[0, ["p7_successes", "p9_successes", "p11_successes"]].tolist() == [19, 0, 9]


def test_the_default_is_the_reading_that_the_rule_selected():
    evidence = pd.read_csv("report/selection.csv", dtype=str)
    assert len(evidence) == 3 * 3 * 3 * 5
    assert evidence["likelihood"].astype(float).is_monotonic_decreasing
    readings = load(Path("config/config.yaml")).readings
    for configured in (readings, Readings()):
        for name in ("reward_unit", "biases", "initial_weights", "learning_rate"):
            value = getattr(configured, name)
            assert evidence.at[0, name] == (
                f"{value:g}" if isinstance(value, float | int) else value
            )


def test_the_evidence_of_the_selection_is_that_of_the_results_where_they_are():
    path = Path("results") / SELECTION
    if not path.exists() or read_study(Path("results")) != load(Path("config/config.yaml")):
        pytest.skip("`make readings` has not been run here")
    found, shown = pd.read_parquet(path), pd.read_csv("report/selection.csv")
    np.testing.assert_allclose(found["likelihood"], shown["likelihood"], rtol=1e-4)
    assert found["p11_successes"].tolist() == shown["p11_successes"].tolist()
