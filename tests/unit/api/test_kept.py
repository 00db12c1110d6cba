"""A study that the history has kept, opened: its tables as they were, and what an entry does not have."""

import shutil

import pandas as pd
import pytest

import upswing
from tests.unit.analysis.histories import judge, stricter
from tests.unit.api.test_study import TABLE, says
from upswing.analysis.history.read import entries
from upswing.analysis.history.write import write_entry
from upswing.study.history_paths import RUNS, folder_of


@pytest.fixture(scope="module")
def folder(results, tmp_path_factory):
    """Results with two entries: the last one was judged by another threshold."""
    folder = tmp_path_factory.mktemp("kept") / "results"
    shutil.copytree(results.folder, folder)
    shutil.rmtree(folder / "history", ignore_errors=True)
    judge(folder)
    write_entry(folder, "as it was")
    judge(folder, stricter())
    write_entry(folder)
    return folder


def test_its_tables_are_those_of_that_time(folder):
    first, now = upswing.open(folder, at="@1"), upswing.open(folder)
    before, after = (one.verdicts.set_index("claim")["threshold"] for one in (first, now))
    assert list(before[before != after].index) == ["C16"]
    pd.testing.assert_frame_equal(upswing.open(folder, at="@last").verdicts, now.verdicts)
    pd.testing.assert_frame_equal(first.cells, now.cells)
    pd.testing.assert_frame_equal(first.runs, now.runs[list(first.runs)])
    assert set(first.evidence["claim"]) == set(now.evidence["claim"])
    assert first.configuration == now.configuration
    assert first.entry.note == "as it was"
    frame = first.runs
    frame["falls"] = -1
    assert (first.runs["falls"] >= 0).all()


@pytest.mark.parametrize("how", ["the number alone", "an id", "the beginning of an id"])
def test_an_entry_is_called_as_the_history_calls_it(folder, monkeypatch, how):
    monkeypatch.chdir(folder.parent)
    identity = entries(folder)[1].id
    opened = {
        "the number alone": lambda: upswing.open("@2"),
        "an id": lambda: upswing.open(at=identity),
        "the beginning of an id": lambda: upswing.open("results", at=identity[:-2]),
    }[how]()
    assert opened.entry.number == 2
    assert repr(opened) == (
        f"<study @2 ({identity}) of the history in results: 4 cells, 12 runs, tables only>"
    )


def test_a_cell_of_it_has_its_runs_and_estimates(folder):
    then, now = (upswing.open(folder, at=at).cell(TABLE) for at in ("@1", None))
    assert then.estimate("falls") == now.estimate("falls")
    assert then.share(then.runs["falls_last_fifth"] == 0) == now.share(
        now.runs["falls_last_fifth"] == 0
    )
    assert then.seeds == now.seeds
    assert [cell.id for cell in upswing.open(folder, at="@1")] == [
        cell.id for cell in upswing.open(folder)
    ]


@pytest.mark.parametrize(
    "asked",
    [
        lambda study: study.run(f"{TABLE}/seed-1"),
        lambda study: study.cell(TABLE).run(1),
        lambda study: study.cell(TABLE).best,
        lambda study: list(study.cell(TABLE)),
        lambda study: study.cell(TABLE).plot(),
    ],
)
def test_what_an_entry_does_not_keep_is_said_in_one_line(folder, asked):
    said = says(lambda: asked(upswing.open(folder, at="@1")))
    assert f"of the history in {folder}: " in said
    assert "an entry keeps tables only; " in said
    assert "\n" not in said


def test_a_run_can_be_learned_by_what_was_asked_for_then(folder):
    run = upswing.open(folder, at="@1").train("balancing", "table", 1, seed=1)
    stored = upswing.open(folder).run(f"{TABLE}/seed-1")
    assert run.measures["digest"] == stored.measures["digest"]


def test_it_opens_where_nothing_but_the_history_is_left(folder, tmp_path):
    shutil.copytree(folder / "history", tmp_path / "results/history")
    study = upswing.open(tmp_path / "results", at="@1")
    assert len(study.runs) == 12
    assert len(study) == 4
    assert "as it was" in study._repr_html_()


def test_what_there_is_no_entry_of_is_said_with_what_there_is(folder, tmp_path, monkeypatch):
    assert "there are @1 to @2" in says(lambda: upswing.open(folder, at="@7"))
    assert "no entry is called so; did you mean '@last'" in says(
        lambda: upswing.open(folder, at="lost")
    )
    assert "there is no entry; " in says(lambda: upswing.open(tmp_path, at="@1"))
    monkeypatch.chdir(folder.parent)
    assert says(lambda: upswing.open("@1", at="@2")) == (
        "open: @1: is an entry; name a folder beside at='@2'"
    )


def test_a_damaged_entry_is_said_with_its_file(folder, tmp_path):
    copy = tmp_path / "results"
    shutil.copytree(folder, copy)
    path = copy / folder_of(entries(copy)[0].id) / RUNS
    path.chmod(0o644)
    path.write_text("no table", "utf-8")
    study = upswing.open(copy, at="@1")
    said = says(lambda: study.runs)
    assert said.startswith(f"{path}: ")
    assert "`upswing doctor" in said
