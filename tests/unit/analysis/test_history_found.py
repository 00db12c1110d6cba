"""Entries of a history by what they are called; deleted, and exported."""

import shutil
from datetime import UTC, datetime, timedelta

import pandas as pd
import pytest

from tests.unit.analysis.histories import ADDED, findings, judge, stricter, whole
from upswing.analysis.history import write as writing
from upswing.analysis.history.change import add_note, delete
from upswing.analysis.history.export import write_export
from upswing.analysis.history.read import entries, find, listed
from upswing.analysis.history.write import write_entry
from upswing.study.errors import BadInput
from upswing.study.history_paths import ENTRIES, HISTORY
from upswing.study.paths import CELLS


@pytest.fixture
def folder(results, tmp_path):
    """A copy of a small study's results, without what other tests may have added to it."""
    copy = tmp_path / "results"
    shutil.copytree(results.folder, copy, ignore=shutil.ignore_patterns(*ADDED))
    return copy


@pytest.fixture
def three(folder, monkeypatch):
    """A folder with three entries: two of one commit, one of another."""
    commits = iter(["abcdef0123456789", "abcdef0123456789", "abcd00ffffffffff"])
    times = iter(datetime(2026, 1, 2, tzinfo=UTC) + timedelta(days=n) for n in range(3))
    real = writing.provenance()

    class Clock:
        @staticmethod
        def now(_):
            return next(times)

    monkeypatch.setattr(writing, "datetime", Clock)
    for at_least in (0.98, 0.999, 0.99):
        judge(folder, stricter(at_least=at_least))
        found = type(real)(**{**real.as_dict(), "git_commit": next(commits), "dirty": False})
        monkeypatch.setattr(writing, "provenance", lambda found=found: found)
        assert write_entry(folder).new
    return folder


def test_an_entry_is_found_by_what_it_is_called(three):
    every = entries(three)
    assert [entry.number for entry in every] == [1, 2, 3]
    assert find(three, "@last") == every[2]
    assert find(three, "@1") == every[0]
    for entry in every:
        assert find(three, entry.id) == entry
        assert find(three, entry.id[:8]) == entry  # its day
    assert find(three, "abcd00") == find(three, "ABCD00FFFFFFFFFF") == every[2]


@pytest.mark.parametrize(
    ("called", "said"),
    [
        ("@4", "there is no such entry; there are @1 to @3, and @last is the newest"),
        ("@0", "there is no such entry"),
        ("@", "there is no such entry"),
        ("@lats", "there is no such entry"),
        ("2026", "there are 3 ids that begin so: @1 (20260102-"),
        ("abcdef", "there are 2 entries of that commit: @1 (20260102-"),
        ("abcd", "there are 3 entries of that commit"),
        ("ffff00", "no entry was made at that commit; there are abcd00ffff, abcdef0123"),
        ("20260104-000000-zzzzzz", "did you mean '20260104-000000-"),
        ("", "no entry is called so"),
        ("--all", "no entry is called so"),
    ],
)
def test_a_wrong_name_is_one_line_that_says_what_there_is(three, called, said):
    with pytest.raises(BadInput) as caught:
        find(three, called)
    (line,) = caught.value.problems
    assert said in line
    assert line.startswith(str(three / HISTORY))
    assert "\n" not in line


def test_a_deleted_entry_is_gone_and_the_others_keep_their_numbers(three):
    one, two, last = entries(three)
    add_note(three, two.id, "a note")
    delete(three, two.id)
    assert [entry.number for entry in entries(three)] == [1, 3]
    assert [entry.id for entry in listed(three)] == [one.id, last.id]
    assert two.id not in " ".join(str(path) for path in three.rglob("*"))
    whole(three)
    assert findings(three) == []
    with pytest.raises(BadInput, match="there are @1 to @3, with gaps"):
        find(three, "@2")
    for entry in (one, last):
        delete(three, entry.id)
    assert entries(three) == listed(three) == []
    with pytest.raises(BadInput, match="there is no entry"):
        find(three, "@last")
    assert (three / ENTRIES).is_file()


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_the_export_has_every_number_of_every_entry(three, tmp_path, ending):
    file = tmp_path / f"history.{ending}"
    rows, count = write_export(three, file)
    table = pd.read_csv(file) if ending == "csv" else pd.read_parquet(file)
    assert (len(table), count) == (rows, 3)
    assert sorted(table["number"].unique()) == [1, 2, 3]
    cells = pd.read_parquet(three / CELLS).set_index("cell")
    own = table[(table["what"] == "cell") & (table["number"] == 2)]
    for row in own[own["statistic"] == "mean"].to_dict("records"):
        expected = cells.loc[row["of"]]
        for name, column in (("value", ""), ("low", "_low"), ("high", "_high")):
            number = expected[f"{row['measure']}_mean{column}"]
            assert row[name] == pytest.approx(number, nan_ok=True)
    judged = table[(table["what"] == "verdict") & (table["of"] == "C16")].set_index("number")
    for entry in entries(three):
        assert judged.loc[entry.number, "verdict"] == entry.verdicts["C16"]


def test_an_export_of_another_kind_or_of_nothing_is_refused(three, tmp_path):
    with pytest.raises(BadInput, match=r"history\.xlsx: must end with \.parquet or \.csv"):
        write_export(three, tmp_path / "history.xlsx")
    with pytest.raises(BadInput, match="there is no entry to export"):
        write_export(tmp_path, tmp_path / "history.csv")
    assert not list(tmp_path.glob("history.*"))
