"""Sweeps over readings: what is swept, what comes of it, which reading is the default, what decides."""

import itertools
import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.helpers import ARCHITECTURES
from upswing.claims import load_claims
from upswing.config import load, validated
from upswing.figures.readings import draw_readings
from upswing.matrix import Matrix
from upswing.problems import BadInput
from upswing.readings import Readings
from upswing.study import canonical, read_study, write_study
from upswing.sweeps.names import DECISIVE, READINGS, ROBUST, SELECTION
from upswing.sweeps.plan import (
    Sweep,
    canonical_of,
    content_of,
    groups,
    label,
    load_sweeps,
    options_of,
    specs,
)
from upswing.sweeps.results import write_readings
from upswing.sweeps.robustness import decisive, summary, sweep_of
from upswing.sweeps.selection import CELLS, select
from upswing.sweeps.sweep import write_group
from upswing.tables import collect_runs
from upswing.train import train

STUDY = validated(
    {
        "study": {
            "seeds": 3,
            "tasks": {
                "balancing": {"kind": "balancing", "steps": 2_000},
                "full-control": {"kind": "full-control", "steps": 2_000},
            },
            "architectures": {
                name: ARCHITECTURES[name]
                for name in ("table", "networks-5", "networks-30", "modular-networks-5", "random")
            },
            "experiments": [
                {"tasks": ["balancing"], "architectures": ["table", "networks-5"], "alphas": [1]},
                {"tasks": ["balancing"], "architectures": ["table"], "alphas": [0.001]},
                {"tasks": ["balancing"], "architectures": ["random"]},
                {
                    "tasks": ["full-control"],
                    "architectures": ["networks-30", "modular-networks-5"],
                    "alphas": [1],
                },
            ],
        }
    }
)
SWEEPS = """
selection:
  vary: [biases, initial_weights]
  how: grid
  first_seed: 1000
  seeds: 2
  cells: [balancing/networks-5/alpha-1, full-control/networks-30/alpha-1, full-control/modular-networks-5/alpha-1]
networks:
  vary: [biases, initial_weights]
  how: grid
  seeds: 2
  cells: [balancing/random/alpha-none, balancing/table/alpha-1, balancing/networks-5/alpha-1, full-control/modular-networks-5/alpha-1]
tables:
  vary: [first_q, reset, wrap]
  how: pairs
  without: [[reset, wrap]]
  seeds: 2
  cells: [balancing/random/alpha-none, balancing/table/alpha-1]
  cells_of_singles: [balancing/table/alpha-0.001]
"""


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """A folder in which small sweeps were run, and the sweeps."""
    folder = tmp_path_factory.mktemp("swept")
    (folder / "readings.yaml").write_text(SWEEPS, "utf-8")
    write_study(canonical(STUDY), folder)
    sweeps = load_sweeps(folder / "readings.yaml", STUDY)
    for name, sweep in sweeps.items():
        for group in groups(sweep, STUDY):
            write_group(folder, STUDY, name, sweep, group.name)
    return folder, sweeps


# What is swept.


def test_a_grid_is_every_combination_once(swept):
    _, sweeps = swept
    members = [m for group in groups(sweeps["networks"], STUDY) for m in group.members]
    expected = itertools.product(options_of("biases"), options_of("initial_weights"))
    assert [tuple(m.values()) for m in members] == list(expected)


def test_pairs_are_the_study_single_changes_and_two_at_a_time(swept):
    _, sweeps = swept
    members = [m for group in groups(sweeps["tables"], STUDY) for m in group.members]
    assert len({canonical_of(m) for m in members}) == len(members)
    assert [len(m) for m in members].count(0) == 1
    singles = [m for m in members if len(m) == 1]
    assert len(singles) == 2 + 2 + 1  # first_q, reset, wrap
    pairs = [set(m) for m in members if len(m) == 2]
    assert len(pairs) == 2 * 2 + 2 * 1
    assert {"reset", "wrap"} not in pairs


def test_the_project_s_own_sweeps_fit_its_study():
    study = load(Path("config/config.yaml"))
    sweeps = load_sweeps(Path("config/readings.yaml"), study)
    assert set(sweeps) == {"selection", "networks", "tables"}
    assert set(CELLS.values()) == set(sweeps["selection"].cells)
    for sweep in sweeps.values():
        assert sweep.seeds >= 10
        verdict_seeds, own = (
            set(study.seeds),
            set(range(sweep.first_seed, sweep.first_seed + sweep.seeds)),
        )
        assert (sweep is sweeps["selection"]) == verdict_seeds.isdisjoint(own)
    assert sum(len(group.members) for group in groups(sweeps["networks"], study)) == 3 * 3 * 3 * 5


def test_what_a_job_depends_on_is_in_its_checksum(swept):
    _, sweeps = swept
    group = groups(sweeps["networks"], STUDY)[0]

    def of(study):
        return content_of(sweeps["networks"], study, group, Matrix(study).cells)

    before = of(STUDY)
    more_seeds = STUDY.model_copy(update={"seeds": (0, 1, 2, 3)})
    assert of(more_seeds) == before
    other_epsilon = STUDY.model_copy(update={"epsilon": 0.1})
    assert of(other_epsilon) != before
    readings = STUDY.readings.model_copy(update={"biases": "both"})
    # The grid fixes it anyway.
    assert of(STUDY.model_copy(update={"readings": readings})) == before


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("tables: {vary: [first_Q], how: pairs, seeds: 2, cells: [a]}", "did you mean 'first_q'"),
        ("tables: {vary: [ties], how: all, seeds: 2, cells: [a]}", "tables.how"),
        ("tables: {vary: [ties], how: grid, seeds: 0, cells: [a]}", "tables.seeds"),
        ("tables: {vary: [ties], how: grid, seeds: 2}", "tables.cells"),
        ("tables: {vary: [ties], without: [[ties, wrap]], how: grid, seeds: 2, cells: [a]}", "'wrap': no such reading"),
        ("- 3", "must hold keys and values"),
    ],
)  # fmt: skip
def test_bad_sweeps_are_explained(tmp_path, text, expected):
    path = tmp_path / "readings.yaml"
    path.write_text(text, "utf-8")
    with pytest.raises(BadInput) as caught:
        load_sweeps(path, STUDY)
    assert expected in str(caught.value)
    assert "readings.yaml" in str(caught.value)


def test_a_study_without_the_cells_sweeps_nothing(tmp_path):
    path = tmp_path / "readings.yaml"
    path.write_text("a: {vary: [ties], how: grid, seeds: 1, cells: [no/such/cell]}", "utf-8")
    assert load_sweeps(path, STUDY) == {}
    write_study(canonical(STUDY), tmp_path)
    with pytest.raises(BadInput, match="no sweep"):
        write_readings(tmp_path, {}, {})


# What comes of it.


def test_a_swept_run_is_the_run_that_training_makes(swept, tmp_path):
    folder, sweeps = swept
    under = {"first_q": "pessimistic"}
    rows = pd.read_parquet(folder / "readings/tables/as-the-study.parquet")
    rows = rows[rows["readings"] == canonical_of(under)]
    study = STUDY.model_copy(update={"readings": Readings(first_q="pessimistic"), "seeds": (0, 1)})
    matrix = Matrix(study)
    write_study(canonical(study), tmp_path)
    for spec in specs(sweeps["tables"], STUDY, under):
        train(spec, tmp_path)
    cells = {spec.cell for spec in specs(sweeps["tables"], STUDY, under)}
    for cell in set(matrix.cells) - cells:
        train(matrix.cells[cell], tmp_path)
    trained = collect_runs(tmp_path, matrix).set_index("run")
    assert len(rows) == 6
    for row in rows.to_dict("records"):
        compared = ["falls", "upright_share", "mean_reward", "greedy_success_share"]
        if row["architecture"] == "table":  # a control's TD errors are stored as unknown
            compared.append("digest")
        for name in compared:
            assert row[name] == trained.at[row["run"], name], (row["run"], name)


def test_its_tables_and_figures_are_made(swept):
    folder, sweeps = swept
    claims = load_claims(Path("config/claims.yaml"))
    few = {name: claims[name] for name in ("C1", "C2", "C4", "C12", "C13", "C14", "C15", "C16")}
    robust = write_readings(folder, sweeps, few).set_index("claim")
    judged = pd.read_parquet(folder / READINGS)
    assert robust.loc[["C12", "C13"], "readings"].tolist() == [9, 9]
    assert robust.at["C1", "readings"] == 1 + 5 + 6
    assert "C16" not in robust.index
    assert set(judged.loc[judged["sweep"] == "networks", "claim"]) == {
        "C4",
        "C12",
        "C13",
        "C14",
        "C15",
    }
    verdicts = ["reproduced", "partly", "inconclusive", "not reproduced"]
    assert (robust[verdicts].sum(axis=1) == robust["readings"]).all()
    assert judged.groupby("claim")["is_default"].sum().eq(1).all()
    assert len(pd.read_parquet(folder / SELECTION)) == 9
    assert set(pd.read_parquet(folder / DECISIVE).columns) >= {
        "claim",
        "readings",
        "effect",
        "under",
    }
    assert len(pd.read_parquet(folder / ROBUST)) == len(robust)
    for path in draw_readings(folder, sweeps):
        assert path.stat().st_size > 5_000
        assert path.with_suffix(".png").exists()


def test_missing_groups_are_named(swept, tmp_path):
    _, sweeps = swept
    write_study(canonical(STUDY), tmp_path)
    with pytest.raises(BadInput, match="`make readings` makes them"):
        write_readings(tmp_path, sweeps, load_claims(Path("config/claims.yaml")))
    with pytest.raises(BadInput, match="no such group; did you mean 'as-the-study'"):
        write_group(tmp_path, STUDY, "tables", sweeps["tables"], "as-the-studi")


# The rule of selection.


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


# What decides a claim.

GRID = Sweep(vary=("biases", "initial_weights"), how="grid", seeds=1, cells=("a",))
PAIRS = Sweep(vary=("first_q", "reset", "wrap"), how="pairs", seeds=1, cells=("a",))


def grid_of(holds):
    rows = []
    for biases, weights in itertools.product(options_of("biases"), options_of("initial_weights")):
        held = holds(biases, weights)
        rows.append(
            {
                "claim": "C1", "sweep": "networks", "biases": biases, "initial_weights": str(weights),
                "readings": json.dumps({"biases": biases, "initial_weights": weights}),
                "holds": held, "estimate_holds": held, "verdict": "partly" if held else "inconclusive",
                "is_default": False,
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
    assert summary(grid_of(lambda *_: True)).at[0, "holds"] == 9


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
