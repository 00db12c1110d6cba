"""A history: an entry for what came out otherwise, whole or not there, which never changes."""

import json
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from tests.unit.analysis.histories import ADDED, CLAIMS, findings, judge, stricter, whole
from upswing.analysis.history.change import add_note
from upswing.analysis.history.read import damaged, entries, listed
from upswing.analysis.history.sides import of_entry, of_folder
from upswing.analysis.history.write import write_entry
from upswing.runs.files.tables import write_table
from upswing.runs.study_file import write_study
from upswing.study.errors import BadInput
from upswing.study.history_paths import ENTRIES, HISTORY, folder_of, notes_of
from upswing.study.paths import CELLS, CHECKSUMS, RUNS


@pytest.fixture
def folder(results, tmp_path):
    """A copy of a small study's results, without what other tests may have added to it."""
    copy = tmp_path / "results"
    shutil.copytree(results.folder, copy, ignore=shutil.ignore_patterns(*ADDED))
    return copy


def test_an_entry_holds_what_was_asked_and_what_came_out(folder):
    found = write_entry(folder, "a note")
    assert found.new
    (entry,) = entries(folder)
    assert entry == found.entry
    assert (entry.number, entry.before, entry.note) == (1, None, "a note")
    assert (entry.runs.all, entry.cells) == (12, 4)
    verdicts = pd.read_parquet(folder / "tables/verdicts.parquet")
    assert entry.verdicts == dict(zip(verdicts["claim"], verdicts["verdict"], strict=True))
    side, now = of_entry(folder, entry.id), of_folder(folder)
    assert side.configuration == now.configuration
    assert set(side.configuration["claims"]) == set(CLAIMS)
    pd.testing.assert_frame_equal(side.cells, now.cells)
    pd.testing.assert_frame_equal(side.verdicts, now.verdicts)
    pd.testing.assert_frame_equal(side.evidence, now.evidence)
    assert side.runs["digest"].tolist() == now.runs["digest"].tolist()
    assert set(side.runs) >= {"falls", "upright_share", "upright_at_end", "first_stable_step"}
    assert listed(folder) == [entry]


def test_an_entry_is_read_only_and_sealed(folder):
    entry = write_entry(folder).entry
    files = list((folder / folder_of(entry.id)).iterdir())
    assert all(path.stat().st_mode & 0o222 == 0 for path in files)
    whole(folder)
    assert findings(folder) == []
    damaged_file = folder / folder_of(entry.id) / "cells.parquet"
    damaged_file.chmod(0o644)
    damaged_file.write_bytes(damaged_file.read_bytes()[:-1] + b"x")
    (finding,) = findings(folder)
    assert finding.path == damaged_file
    assert f"upswing history delete {entry.id} --yes" in finding.remedy
    assert "run the study again" not in finding.remedy


def test_damaged_notes_are_found_and_can_be_removed(folder):
    entry = write_entry(folder).entry
    add_note(folder, entry.id, "later")
    notes = folder / notes_of(entry.id)
    notes.write_text(notes.read_text("utf-8").replace("later", "sooner"), "utf-8")
    (finding,) = findings(folder)
    assert finding.path == notes
    for path in shlex.split(finding.remedy.partition("#")[0])[2:]:
        Path(path).unlink()
    assert findings(folder) == []


def test_what_comes_to_the_same_adds_no_entry(folder):
    entry = write_entry(folder, "first").entry
    files = {path: path.read_bytes() for path in (folder / folder_of(entry.id)).iterdir()}
    judge(folder)
    runs = pd.read_parquet(folder / RUNS)
    write_table(folder / RUNS, runs.assign(seconds=runs["seconds"] * 2, git_commit="another"))
    cells = pd.read_parquet(folder / CELLS)
    cells["steps_per_second_median"] *= 2
    cells["falls_mean"] *= 1 + 1e-12  # another machine's last digits
    write_table(folder / CELLS, cells)
    again = write_entry(folder, "second")
    assert not again.new
    assert again.entry.id == entry.id
    assert [one.id for one in entries(folder)] == [entry.id]
    assert files == {path: path.read_bytes() for path in (folder / folder_of(entry.id)).iterdir()}


def test_a_threshold_is_named_and_the_verdict_that_it_changed(folder):
    first = write_entry(folder).entry
    judge(folder, stricter())
    second = write_entry(folder).entry
    assert second.number == 2
    assert second.before == first.id
    assert [(row.what, row.before, row.after) for row in second.configuration] == [
        ("claims.C16.parts[0].at_least", "0.98", "0.999")
    ]
    (changed,) = second.changed_verdicts
    assert (changed.what, changed.before) == ("C16", "reproduced")
    assert changed.after == second.verdicts["C16"] != "reproduced"
    assert (second.runs.new, second.runs.changed, second.runs.gone, second.changed_cells) == (
        0,
        0,
        0,
        0,
    )


def test_runs_and_cells_that_differ_are_counted(folder):
    write_entry(folder)
    runs, cells = pd.read_parquet(folder / RUNS), pd.read_parquet(folder / CELLS)
    runs.loc[0, "digest"] = "another"
    runs.loc[1, "run"] = runs.loc[1, "run"].replace("seed-1", "seed-7")
    write_table(folder / RUNS, runs)
    cells.loc[0, "falls_mean"] += 1
    write_table(folder / CELLS, cells)
    entry = write_entry(folder).entry
    assert (entry.runs.all, entry.runs.new, entry.runs.changed, entry.runs.gone) == (12, 1, 1, 1)
    assert entry.changed_cells == 1
    assert entry.configuration == ()


def test_another_folder_for_the_same_study_is_no_change(folder):
    write_entry(folder)
    study = json.loads((folder / "study.json").read_text("utf-8"))
    write_study(json.dumps({**study, "results": "elsewhere"}), folder)
    assert not write_entry(folder).new
    write_study(json.dumps({**study, "seeds_per_job": 7}), folder)
    (changed,) = write_entry(folder).entry.configuration
    assert (changed.what, changed.before, changed.after) == ("seeds_per_job", "30", "7")


def test_what_cannot_be_read_of_the_last_entry_keeps_none_from_being_written(folder):
    entry = write_entry(folder).entry
    path = folder / folder_of(entry.id) / "runs.parquet"
    path.unlink()
    judge(folder, stricter())
    second = write_entry(folder).entry
    assert (second.number, second.before) == (2, None)
    head = folder / folder_of(entry.id) / "entry.json"
    head.unlink()
    head.write_text("{}", "utf-8")
    assert [one.number for one in entries(folder)] == [2]
    (line,) = damaged(folder)
    assert str(head) in line
    judge(folder)
    assert write_entry(folder).entry.number == 3


PROGRAM = """
import os, pathlib, shutil, signal, sys
import pyarrow.parquet as pq
count = 0
def counted(function):
    def call(*words, **more):
        global count
        count += 1
        if count == int(sys.argv[2]):
            os.kill(os.getpid(), signal.SIGKILL)
        return function(*words, **more)
    return call
for name in ("write_text", "write_bytes", "replace"):
    setattr(pathlib.Path, name, counted(getattr(pathlib.Path, name)))
for where, name in ((pq, "write_table"), (shutil, "copyfile"), (shutil, "rmtree")):
    setattr(where, name, counted(getattr(where, name)))
from upswing.analysis.history.write import write_entry
write_entry(pathlib.Path(sys.argv[1]))
"""


def test_kill_9_at_any_step_leaves_no_half_entry(folder, tmp_path):
    write_entry(folder)
    judge(folder, stricter())
    killed, seen = 0, set()
    for step in range(1, 40):
        copy = tmp_path / f"copy-{step}"
        shutil.copytree(folder, copy, ignore=shutil.ignore_patterns("runs"))
        done = subprocess.run(
            [sys.executable, "-c", PROGRAM, str(copy), str(step)], capture_output=True, check=False
        )
        whole(copy)
        seen.add(len(entries(copy)))
        if done.returncode == 0:
            break
        assert done.returncode == -9, done.stderr
        killed += 1
        # The next job removes what is left over, and writes what is missing.
        write_entry(copy)
        assert [entry.number for entry in entries(copy)] == [1, 2]
        whole(copy)
        assert not list((copy / HISTORY).glob(".*"))
        ledgers = {path.stem for path in (copy / CHECKSUMS / HISTORY).iterdir()}
        assert ledgers == {entry.id for entry in entries(copy)}
        assert [entry.id for entry in listed(copy)] == [entry.id for entry in entries(copy)]
        shutil.rmtree(copy)
    assert done.returncode == 0
    assert killed > 10
    assert seen == {1, 2}


def test_notes_stand_beside_an_entry_that_does_not_change(folder):
    entry = write_entry(folder, "at once").entry
    files = {path: path.read_bytes() for path in (folder / folder_of(entry.id)).iterdir()}
    add_note(folder, entry.id, "later")
    add_note(folder, entry.id, "later still")
    (found,) = entries(folder)
    assert found.every_note == ["at once", "later", "later still"]
    assert listed(folder) == [found]
    assert files == {path: path.read_bytes() for path in (folder / folder_of(entry.id)).iterdir()}
    assert findings(folder) == []
    assert not write_entry(folder).new
    assert listed(folder) == [found]


def test_the_list_of_another_origin_is_refused(folder):
    write_entry(folder)
    (folder / ENTRIES).write_text("[1]", "utf-8")
    with pytest.raises(BadInput, match=r"entries\.json: is no such file of a history"):
        listed(folder)
    write_entry(folder)
    assert len(listed(folder)) == 1
