"""A folder of results, opened: its tables, its cells, its runs, and errors that name near ones."""

import numpy as np
import pandas as pd
import pytest

import upswing
from tests.made_up import ONE, OTHER, N, made_up
from tests.unit.api.said import says
from upswing.analysis import statistics
from upswing.runs.files.tables import read_cells
from upswing.study.paths import RUNS, VERDICTS

TABLE = "balancing/table/alpha-1"


# The folder.


def test_the_tables_are_those_of_the_folder(study, results):
    pd.testing.assert_frame_equal(study.runs.drop(columns="cell"), pd.read_parquet(results.folder / RUNS))  # fmt: skip
    pd.testing.assert_frame_equal(study.verdicts, pd.read_parquet(results.folder / VERDICTS))
    assert set(study.cells["cell"]) == set(study.runs["cell"])
    assert set(study.evidence["claim"]) <= set(study.verdicts["claim"])
    assert study.configuration.seeds == (0, 1, 2)


def test_a_table_that_is_changed_changes_nothing_else(study):
    for frame in (study.runs, study.cell(TABLE).runs):
        frame["falls"] = -1
    assert (study.runs["falls"] >= 0).all()
    assert (study.cell(TABLE).runs["falls"] >= 0).all()


def test_it_says_what_it_is(study, results):
    assert repr(study) == f"<study in {results.folder}: 4 cells, 12 runs>"
    shown = study._repr_html_()
    assert "balancing, full-control" in shown
    assert len(shown) < 1_000


def test_what_is_no_folder_of_results_is_said_with_what_there_is(results, tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/study.json").write_text("{}", "utf-8")
    missing = tmp_path / "results"
    assert says(lambda: upswing.open(missing)) == (
        f"{missing}: missing; it should be a folder of results; in {tmp_path} there are mine"
    )
    assert "there is no study.json in it" in says(lambda: upswing.open(tmp_path))
    assert "is a file" in says(lambda: upswing.open(results.folder / "study.json"))
    with pytest.raises(upswing.BadInput, match=r"mine/study\.json"):
        upswing.open(tmp_path / "mine")


def test_a_folder_without_tables_opens_and_says_how_to_make_them(results, tmp_path):
    (tmp_path / "study.json").write_bytes((results.folder / "study.json").read_bytes())
    opened = upswing.open(tmp_path)
    assert len(opened) == 4
    assert "verdicts" not in opened._repr_html_()
    for table in ("runs", "cells", "verdicts", "evidence"):
        assert "missing; `upswing" in says(lambda table=table: getattr(opened, table))


# Cells.


def test_cells_are_gone_through_in_order(study, results):
    assert [cell.id for cell in study] == list(results.cells)
    assert len(study) == 4


@pytest.mark.parametrize(
    "asked",
    [
        {"cell": TABLE},
        {"cell": f"runs/{TABLE}/"},
        {"task": "balancing", "architecture": "table", "alpha": 1},
        {"architecture": "table", "alpha": 1.0},
    ],
)
def test_a_cell_is_found_by_its_id_or_its_parts(study, asked):
    cell = study.cell(**asked)
    assert cell.id == TABLE
    assert (cell.task.name, cell.architecture, cell.alpha) == ("balancing", "table", 1)
    assert cell.seeds == (0, 1, 2)
    assert repr(cell) == f"<cell {TABLE}: 3 runs of 7,000 steps>"


def test_a_control_has_no_alpha(study):
    assert study.cell(architecture="idle").alpha is None


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"cell": "balancing/tabel/alpha-1"}, f"no such cell; did you mean '{TABLE}'?"),
        ({"task": "balancing", "architecture": "table"}, f"2 cells are that: {TABLE}, "),
        ({"task": "full-control", "architecture": "table"}, "no cell is that"),
        ({"architecture": "tabel"}, "architecture: tabel: no cell has it; did you mean 'table'?"),
        ({"alpha": 0.2}, "alpha: 0.2: no cell has it"),
        ({"alpha": "half"}, "alpha: half: no cell has it; there are 0.1, 1, none"),
        ({"task": "balancing", "alpha": [1]}, "alpha: [1]: no cell has it"),
        ({}, "cell: 4 cells are that"),
        ({"cell": TABLE, "alpha": 1}, "give an id, or task, architecture and alpha"),
    ],
)
def test_a_cell_that_there_is_not_is_said_with_near_ones(study, asked, said):
    assert said in says(lambda: study.cell(**asked))


def test_estimates_are_those_of_the_table_of_cells(study, results):
    rows = read_cells(results.folder, results.cells).set_index("cell")
    for cell in study:
        for of in statistics.LOCATIONS:
            found, row = cell.estimate("upright_share", of), rows.loc[cell.id]
            assert (found.value, found.low, found.high, found.n) == (
                row[f"upright_share_{of}"], row[f"upright_share_{of}_low"],
                row[f"upright_share_{of}_high"], row["runs"],
            )  # fmt: skip


def test_runs_that_diverged_do_not_count_nor_those_without_a_number(tmp_path):
    diverged = np.where(np.arange(N) < 10, 500.0, np.nan)
    speed = np.where(np.arange(N) < 30, np.nan, np.arange(N))
    never = np.full(N, np.nan)
    made_up(
        tmp_path, diverged_at=[diverged, never, never], arrival_speed=[speed, np.arange(N), speed]
    )
    study = upswing.open(tmp_path)
    cell = study.cell(ONE)
    assert cell.estimate("falls").n == N - 10
    assert cell.estimate("falls").value == np.arange(10, N).mean()
    assert cell.estimate("arrival_speed").value == np.arange(30, N).mean()
    few = cell.share(cell.runs["falls"] < 20)
    assert few == statistics.share(10, N - 10)
    assert "of the rows of" in says(lambda: cell.share(study.cell(OTHER).runs["falls"] < 3))


def test_a_measure_that_there_is_not_is_said_with_a_near_one(study):
    cell = study.cell(TABLE)
    assert "measure: fals: no such measure; did you mean 'falls'?" in says(lambda: cell.estimate("fals"))  # fmt: skip
    assert "no such measure" in says(lambda: cell.estimate("seed"))
    assert "of: meen: did you mean 'mean'?" in says(lambda: cell.estimate("falls", "meen"))


def test_worst_median_and_best_are_those_of_the_study(study, results):
    for cell in study:
        three = [cell.worst.id, cell.median.id, cell.best.id]
        assert three == list(results.three_of(cell.id)["run"])


def test_a_cell_shows_its_means_with_their_intervals(study):
    shown = study.cell(TABLE)._repr_html_()
    found = study.cell(TABLE).estimate("falls")
    assert f"{found.value:.4g}  ({found.low:.4g} to {found.high:.4g})" in shown


# Runs.


def test_runs_of_a_cell_are_gone_through_by_their_seeds(study):
    cell = study.cell(TABLE)
    assert [run.id for run in cell] == [f"{TABLE}/seed-{seed}" for seed in (0, 1, 2)]
    assert len(cell) == 3


@pytest.mark.parametrize(
    "asked",
    [
        f"{TABLE}/seed-1",
        f"results/runs/{TABLE}/seed-1.rrd",
        f"/elsewhere/runs/{TABLE}/seed-1.weights.safetensors",
    ],
)
def test_a_run_is_found_by_its_id_or_a_file_of_it(study, asked):
    assert study.run(asked).id == f"{TABLE}/seed-1"


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (f"{TABLE}/seed-9", "seed: 9: no such run; it has 3, from 0 to 2"),
        ("balancing/table/alpha-2/seed-0", "no such cell; did you mean"),
        (TABLE, "a run is task/architecture/alpha-α/seed-n"),
        (f"{TABLE}/seed-x", "a run is task/architecture/alpha-α/seed-n"),
    ],
)
def test_a_run_that_there_is_not_is_said(study, asked, said):
    assert said in says(lambda: study.run(asked))
