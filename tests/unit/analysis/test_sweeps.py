"""Sweeps over readings: what is swept, and what comes of it."""

import itertools
from pathlib import Path

import pandas as pd
import pytest

from tests.helpers import ARCHITECTURES
from upswing.analysis.robustness.selection import CELLS
from upswing.analysis.robustness.write import write_readings
from upswing.figures.readings import draw_readings
from upswing.runs.rows import collected
from upswing.runs.study_file import canonical, write_study
from upswing.runs.sweep import write_group
from upswing.runs.train import train
from upswing.study.claims import load_claims
from upswing.study.config import load, validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.paths import DECISIVE, READINGS, ROBUST, SELECTION
from upswing.study.readings import Readings
from upswing.study.sweeps import (
    canonical_of,
    content_of,
    groups,
    load_sweeps,
    options_of,
    specs,
)

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
        ("tables: {vary: [first_Q], how: pairs, seeds: 2, cells: [balancing/table/alpha-1]}", "did you mean 'first_q'"),
        ("tables: {vary: [ties], how: all, seeds: 2, cells: [balancing/table/alpha-1]}", "tables.how"),
        ("tables: {vary: [ties], how: grid, seeds: 0, cells: [balancing/table/alpha-1]}", "tables.seeds"),
        ("tables: {vary: [ties], how: grid, seeds: 2}", "tables.cells"),
        ("tables: {vary: [ties], without: [[ties, wrap]], how: grid, seeds: 2, cells: [balancing/table/alpha-1]}", "\"wrap\": no such reading"),
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
    text = "a: {vary: [ties], how: grid, seeds: 1, cells: [full-control/table/alpha-1]}"
    path.write_text(text, "utf-8")
    with pytest.raises(BadInput, match="no study here has this cell"):
        load_sweeps(path, STUDY)
    (tmp_path / "config.yaml").write_text(
        "seeds: 1\ntasks: {full-control: {kind: full-control, steps: 10}}\n"
        "architectures: {table: {learner: table}}\n"
        "experiments: [{tasks: [full-control], architectures: [table], alphas: [1]}]\n",
        "utf-8",
    )
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
    trained = collected(tmp_path, matrix.cells.values()).set_index("run")
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
