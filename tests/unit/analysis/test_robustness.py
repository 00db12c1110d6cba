"""Which readings decide a claim."""

import itertools
import json
from pathlib import Path

import pandas as pd
import pytest

from tests.made_up import FROM, part
from upswing.analysis.robustness.judging import decisive, summary, sweep_of
from upswing.study.claims import Claim, load_claims
from upswing.study.config import load
from upswing.study.sweeps import (
    Sweep,
    label,
    load_sweeps,
    options_of,
)

GRID = Sweep(
    vary=("biases", "initial_weights"), how="grid", seeds=1, cells=("balancing/table/alpha-1",)
)
PAIRS = Sweep(
    vary=("first_q", "reset", "wrap"), how="pairs", seeds=1, cells=("balancing/table/alpha-1",)
)


def grid_of(holds):
    rows = []
    for biases, weights in itertools.product(options_of("biases"), options_of("initial_weights")):
        held = holds(biases, weights)
        rows.append(
            {
                "claim": "C1", "sweep": "networks", "biases": biases, "initial_weights": str(weights),
                "readings": json.dumps({"biases": biases, "initial_weights": weights}),
                "holds": held, "estimate_holds": held, "verdict": "partly" if held else "inconclusive",
                "probability": 0.9 if held else 0.2, "is_default": biases == "none" and weights == 0.1,
            }
        )  # fmt: skip
    return pd.DataFrame(rows)


def test_a_reading_that_alone_decides_explains_all_of_it():
    found = decisive(grid_of(lambda biases, _: biases == "none"), {"networks": GRID})
    assert found["readings"].tolist() == ["R10"]
    assert found.at[0, "effect"] == pytest.approx(1)
    assert "none: 100%" in found.at[0, "under"]


def test_two_readings_that_decide_together_are_a_pair():
    order = ["none", "hidden", "both"]
    weights = [1, 0.5, 0.1]
    found = decisive(
        grid_of(lambda b, w: (order.index(b) + weights.index(w)) % 3 == 0), {"networks": GRID}
    )
    assert found["readings"].tolist() == ["R10 × R11"]
    assert found.at[0, "effect"] == pytest.approx(1)


def test_nothing_decides_what_is_always_the_same():
    assert decisive(grid_of(lambda *_: True), {"networks": GRID}).empty


def test_a_claim_is_summed_up_over_its_readings():
    """It holds under six of nine, each as likely as any other, for the sweep has no reports."""
    judged = grid_of(lambda biases, _: biases != "both")
    claims = {
        "C1": Claim(statement="…", section="…", parts=[part("share_contracting", [], **FROM)])
    }
    no_runs = pd.DataFrame({"cell": [], "readings": [], "diverged_at": []})
    (row,) = summary(judged, {"networks": GRID}, claims, {"networks": no_runs}).to_dict("records")
    assert (row["readings"], row["holds"], row["estimate_holds"]) == (9, 6, 6)
    assert (row["partly"], row["inconclusive"], row["reproduced"]) == (6, 3, 0)
    assert row["default"] == "partly"
    assert row["held_share"] == pytest.approx(6 / 9)
    expected = (6 * 0.9 + 3 * 0.2) / 9
    shares = [row[f"weighted_{what}"] for what in ("share", "low", "high")]
    assert shares == pytest.approx([expected] * 3)
    assert (row["grade"], row["left_out"], row["by_prior"]) == ("depends on the reading", "", "")


def test_changes_alone_and_in_pairs_that_turn_a_claim():
    def row(readings, holds):
        return {"claim": "C1", "sweep": "tables", "readings": json.dumps(readings), "holds": holds,
                "estimate_holds": holds, "verdict": "partly", "is_default": not readings}  # fmt: skip

    judged = pd.DataFrame(
        [
            row({}, True),
            row({"first_q": "random"}, False),
            row({"reset": "terminal"}, True),
            row({"wrap": "unbounded"}, True),
            row({"first_q": "random", "reset": "terminal"}, False),
            row({"reset": "terminal", "wrap": "unbounded"}, False),
        ]
    )
    found = decisive(judged, {"tables": PAIRS}).set_index("readings")
    assert set(found.index) == {"R5", "R7 × R4"} or set(found.index) == {"R5", "R4 × R7"}
    assert found.at["R5", "effect"] == 1
    assert found.at["R5", "under"] == "fails with random"


def test_a_claim_is_judged_where_most_of_what_touches_it_varies():
    study = load(Path("config/config.yaml"))
    sweeps = load_sweeps(Path("config/readings.yaml"), study)
    claims = load_claims(Path("config/claims.yaml"))
    where = {name: sweep_of(claim, sweeps, study) for name, claim in claims.items()}
    of_networks = {"C4", "C5", "C6", "C10", "C12", "C13", "C14", "C15"}
    assert {name for name, sweep in where.items() if sweep == "networks"} == of_networks
    assert where["C16"] is None
    assert label({"biases": "none", "learning_rate": 0.3}) == "R10 none, R12 0.3"
