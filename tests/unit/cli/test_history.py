"""``upswing history``: entries listed, shown, noted, exported, deleted."""

import shutil

import pandas as pd
import pytest

from tests.unit.analysis.histories import ADDED, judge, stricter
from tests.unit.cli.terminal import ANSI, columns_of, in_pipe, in_terminal
from upswing.analysis.history.read import entries
from upswing.analysis.history.write import write_entry
from upswing.cli.main import main
from upswing.study.history_paths import NOTE


@pytest.fixture(scope="module")
def made(results, tmp_path_factory):
    """A folder with two entries: a threshold was edited between them."""
    copy = tmp_path_factory.mktemp("history") / "results"
    shutil.copytree(results.folder, copy, ignore=shutil.ignore_patterns(*ADDED))
    judge(copy)
    write_entry(copy, "as the thesis has it")
    judge(copy, stricter())
    write_entry(copy)
    return copy


@pytest.fixture
def folder(made, tmp_path):
    """The same, to change."""
    return shutil.copytree(made, tmp_path / "results")


def run(capsys, *words):
    code = main([str(word) for word in words])
    said = capsys.readouterr()
    return code, said.out, said.err


def test_the_list_begins_with_the_newest_and_names_the_edit(made, capsys):
    code, said, _ = run(capsys, "history", "--results", made)
    assert code == 0
    header, second, *below = said.splitlines()
    assert header.split()[0] == "no."
    one, two = entries(made)
    assert second.startswith("@2 ")
    assert second.endswith(two.id)
    assert [line.strip() for line in below[:3]] == [
        "claims.C16.parts[0].at_least: 0.98 → 0.999",
        f"C16: reproduced → {two.verdicts['C16']}",
        below[2].strip(),
    ]
    assert below[2].startswith("@1 ")
    assert below[2].endswith(one.id)
    assert below[3].strip() == "note: as the thesis has it"
    assert said.splitlines()[-1] == f"{made}: 2 entries"


def test_the_list_fits_a_terminal(made):
    shown = ANSI.sub("", in_terminal(80, "history", "--results", made))
    assert max(map(columns_of, shown.splitlines())) <= 80
    assert "@2" in shown
    shown = ANSI.sub("", in_terminal(80, "history", "show", "@2", "--results", made))
    assert "claims.C16.parts[0].at_least: 0.98 → 0.999" in " ".join(shown.split())


def test_without_an_entry_the_list_says_so(tmp_path, capsys):
    code, said, _ = run(capsys, "history", "--results", tmp_path)
    assert (code, said) == (0, f"{tmp_path}: 0 entries; a study that has run leaves one\n")


def test_an_entry_that_is_damaged_is_said_and_the_others_listed(folder, capsys):
    one, _ = entries(folder)
    head = folder / "history" / one.id / "entry.json"
    head.chmod(0o644)
    head.write_text("{", "utf-8")
    code, said, _ = run(capsys, "history", "--results", folder)
    assert code == 0
    assert f"{head}: is no such file of a history" in said
    assert "1 entry" in said
    assert run(capsys, "history", "delete", one.id, "--yes", "--results", folder)[0] == 0
    assert run(capsys, "history", "--results", folder)[1].count("@") == 1


@pytest.mark.parametrize("where", ["before", "after"])
def test_the_folder_is_named_before_or_after_the_subcommand(made, where, capsys):
    words = ["--results", made, "show"] if where == "before" else ["show", "--results", made]
    code, said, _ = run(capsys, "history", *words)
    assert code == 0
    two = entries(made)[1]
    assert said.startswith(f"@2 ({two.id}), ")
    for text in (two.commit, "numpy", "12 runs", "4 cells", "C16"):
        assert text in said


def test_a_note_is_added(folder, capsys):
    code, said, _ = run(capsys, "history", "note", "@1", "a <b>note</b>", "--results", folder)
    assert code == 0
    assert said.startswith("added to @1 (")
    assert entries(folder)[0].every_note == ["as the thesis has it", "a <b>note</b>"]
    for text in ("two\nlines", "", "x" * 501):
        code, _, error = run(capsys, "history", "note", "@1", text, "--results", folder)
        assert code == 2
        assert error.count("\n") == 2
    assert len(entries(folder)[0].notes) == 1


def test_nothing_is_deleted_without_yes(folder, capsys):
    two = entries(folder)[1]
    code, said, _ = run(capsys, "history", "delete", "@2", "--results", folder)
    assert code == 2
    assert said == f"would delete {folder}/history/{two.id}; nothing is deleted without --yes\n"
    assert len(entries(folder)) == 2
    code, said, _ = run(capsys, "history", "delete", "@2", "--yes", "--results", folder)
    assert (code, said) == (0, f"deleted {folder}/history/{two.id}\n")
    assert [entry.number for entry in entries(folder)] == [1]


def test_a_name_that_leads_elsewhere_deletes_nothing(folder, tmp_path, capsys):
    (tmp_path / "1").mkdir()
    for called in ("../../1", "/", "", ".", "..", "@", "1/../../.."):
        code, _, error = run(capsys, "history", "delete", called, "--yes", "--results", folder)
        assert code == 2, called
        assert error.startswith("upswing: 1 problem:")
    assert (tmp_path / "1").is_dir()
    assert len(entries(folder)) == 2


def test_the_export_says_how_much_it_wrote(made, tmp_path, capsys):
    file = tmp_path / "all.csv"
    code, said, _ = run(capsys, "history", "export", file, "--results", made)
    assert (code, said) == (0, f"{file}: {len(pd.read_csv(file)):,} rows of 2 entries\n")
    assert run(capsys, "history", "export", tmp_path / "all.txt", "--results", made)[0] == 2


def test_the_job_takes_its_note_from_the_environment(folder, monkeypatch, capsys):
    judge(folder)
    monkeypatch.setenv(NOTE, "  why  ")
    code, said, _ = run(capsys, "history", "write", folder)
    assert code == 0
    assert said.splitlines()[0] == f"to repeat it: upswing history write {folder}"
    assert said.splitlines()[1].startswith("wrote @3 (")
    assert entries(folder)[2].note == "why"
    assert "no entry was written" in run(capsys, "history", "write", folder)[1]
    assert "is kept with @3" in run(capsys, "history", "noted", folder)[1]
    monkeypatch.setenv(NOTE, "another")
    said = run(capsys, "history", "noted", folder)[1]
    assert said.startswith("Nothing changed, so no entry of the history was written")
    assert f"--results {folder}" in said
    monkeypatch.delenv(NOTE)
    assert run(capsys, "history", "noted", folder)[1] == ""


def test_an_unknown_entry_is_one_line(made, capsys):
    code, _, error = run(capsys, "history", "show", "@9", "--results", made)
    assert code == 2
    assert "there are @1 to @2" in error
    assert error.count("\n") == 2


@pytest.mark.parametrize("name", ["show", "note", "export", "delete", "write", "noted"])
def test_every_subcommand_of_it_has_help_in_80_columns(name):
    said = in_pipe("history", name, "--help").stdout
    assert f"Usage: upswing history {name} " in said
    assert max(map(columns_of, said.splitlines())) <= 80
