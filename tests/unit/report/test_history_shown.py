"""What the page shows of the history."""

import shutil

import pytest

from tests.unit.analysis.histories import ADDED, judge, stricter
from upswing.analysis.history.change import add_note, delete
from upswing.analysis.history.read import entries
from upswing.analysis.history.write import write_entry, write_list
from upswing.report.history_shown import MOST, history


@pytest.fixture
def folder(results, tmp_path):
    copy = tmp_path / "results"
    shutil.copytree(results.folder, copy, ignore=shutil.ignore_patterns(*ADDED))
    judge(copy)
    write_entry(copy, "the first")
    judge(copy, stricter())
    write_entry(copy)
    return copy


def test_the_newest_comes_first_with_what_changed(folder):
    found = history(folder)
    two, one = found["entries"]
    assert (two.number, one.number, found["older"]) == (2, 1, 0)
    assert one.first
    assert one.notes == ["the first"]
    assert [(row.what, row.before, row.after) for row in two.changed] == [
        ("claims.C16.parts[0].at_least", "0.98", "0.999")
    ]
    assert [row.what for row in two.verdicts] == ["C16"]


def test_each_claim_has_a_verdict_for_each_entry(folder):
    claims = dict(history(folder)["claims"])
    newest, oldest = claims["C16"]
    assert oldest == ("reproduced", "✓", "reproduced")
    assert dict(history(folder, own=True)["claims"])["C16"][1] == ("reproduced", "✓", "holds")
    before = history(folder, own=True)["entries"][0].verdicts[0].before
    assert before == "holds"
    assert newest[0] == entries(folder)[1].verdicts["C16"] != "reproduced"
    judged = {claim for entry in entries(folder) for claim, word in entry.verdicts.items() if word != "not in this study"}  # fmt: skip
    assert set(claims) == judged
    assert "C7" not in claims  # the small study does not have its cells


def test_a_deleted_entry_is_gone_and_a_note_is_shown(folder):
    add_note(folder, entries(folder)[1].id, "later")
    assert history(folder)["entries"][0].notes == ["later"]
    delete(folder, entries(folder)[0].id)
    assert [entry.number for entry in history(folder)["entries"]] == [2]


def test_of_a_long_history_the_newest_are_shown(folder):
    from upswing.study.history_paths import ENTRIES

    path = folder / ENTRIES
    write_list(folder)
    from upswing.analysis.history.entry import Entries
    from upswing.analysis.history.read import listed

    one = listed(folder)[0]
    many = [one.model_copy(update={"number": number}) for number in range(1, MOST + 4)]
    path.write_text(Entries(entries=tuple(many)).model_dump_json(), "utf-8")
    found = history(folder)
    assert [entry.number for entry in found["entries"]] == list(range(MOST + 3, 3, -1))
    assert found["older"] == 3


def test_without_a_history_there_is_nothing_to_show(tmp_path):
    assert history(tmp_path) == {"entries": [], "older": 0, "judges": True, "claims": []}
