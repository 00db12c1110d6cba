"""A folder of results is looked through: what is whole, damaged, missing, left over."""

import json
import shlex
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from upswing.analysis.doctor import delete_orphans, examine
from upswing.analysis.verdicts import OVER_READINGS, write_verdicts
from upswing.cli.main import main
from upswing.figures import draw
from upswing.report.page import write_report
from upswing.runs.files.ledger import ledger_path, ledgers, read_ledger, seal
from upswing.runs.results import Results
from upswing.study.claims import load_claims
from upswing.study.errors import BadInput
from upswing.study.ids import RUN_FILES

CHANGED = "is not the file that was written: its checksum differs"
RUN = "runs/balancing/table/alpha-0.1/seed-1"


LEDGERS = "checksums"


@pytest.fixture
def folder(results, tmp_path):
    """A copy of a small study's results, to damage; without what other tests may have added to it."""
    copy = tmp_path / "results"
    added = ("report", "figures", "recordings", "report.json", "viewer.json", "comparisons.json")
    shutil.copytree(results.folder, copy, ignore=shutil.ignore_patterns(*added))
    return copy


def found(folder):
    return [(str(f.path.relative_to(folder)), f.what) for f in examine(folder).findings]


def resealed(folder, name):
    """The ledger of a job made anew, as somebody would who edits its files on purpose."""
    path = ledger_path(folder, name)
    ledger = read_ledger(path)
    seal(folder, name, [folder / file for file in ledger.files], **ledger.made_from)


def test_whole_results_are_said_to_be_whole(folder, capsys):
    diagnosis = examine(folder)
    assert diagnosis.findings == []
    assert diagnosis.orphans == []
    assert diagnosis.notes == []
    assert (diagnosis.runs, diagnosis.files) == (12, 48 + 4 + 1)  # tables, and the study
    assert main(["doctor", str(folder)]) == 0
    assert "12 runs, 53 files: all whole" in capsys.readouterr().out


@pytest.mark.parametrize("kind", RUN_FILES)
@pytest.mark.parametrize("accident", ["truncated", "flipped", "missing", "empty"])
def test_a_damaged_file_of_a_run_is_found_and_how_to_mend_it_is_said(
    folder, kind, accident, capsys
):
    path = folder / f"{RUN}.{kind}"
    content = path.read_bytes()
    if accident == "truncated":
        path.write_bytes(content[: len(content) // 2])
    elif accident == "flipped":
        middle = len(content) // 2
        path.write_bytes(content[:middle] + bytes([content[middle] ^ 0xFF]) + content[middle + 1 :])
    elif accident == "empty":
        path.write_bytes(b"")
    else:
        path.unlink()
    findings = [f for f in examine(folder).findings if f.path == path]
    assert len(findings) == 1
    assert main(["doctor", str(folder)]) == 1
    said = capsys.readouterr().out
    assert str(path) in said
    assert "run the study again" in said
    assert accident == "missing" or f"rm '{path}'" in said


def flipped(path, draws):
    """One bit of a file is another."""
    content = bytearray(path.read_bytes())
    content[draws.integers(len(content))] ^= 1 << int(draws.integers(8))
    path.write_bytes(content)


def test_every_flipped_bit_of_every_file_is_named(folder):
    """One in each file at a time, more than 500 in all: runs, weights, recordings and tables."""
    draws = np.random.default_rng(0)
    files = [
        path for name in ("runs", "tables") for path in (folder / name).rglob("*") if path.is_file()
    ]
    whole, flips = {path: path.read_bytes() for path in files}, 0
    while flips < 500:
        for path in files:
            flipped(path, draws)
            flips += 1
        assert {finding.path for finding in examine(folder).findings} == set(files)
        for path, content in whole.items():
            path.write_bytes(content)
    assert examine(folder).findings == []


def test_every_flipped_bit_of_a_ledger_is_named_if_it_changes_what_is_read(folder):
    draws, flips, same = np.random.default_rng(0), 0, 0
    paths = list(ledgers(folder).values())
    whole = {path: path.read_bytes() for path in paths}
    while flips < 500:
        changed = set()
        for path in paths:
            flipped(path, draws)
            try:
                if json.loads(path.read_bytes()) == json.loads(whole[path]):
                    same += 1
                    continue
            except ValueError:
                pass
            changed.add(path)
            flips += 1
        named = {finding.path for finding in examine(folder).findings}
        assert changed <= named
        # A job's files cannot be told without their ledger, those of a run can.
        assert {path.parent.name for path in named - changed} <= {"tables", folder.name}
        for path, content in whole.items():
            path.write_bytes(content)
    assert same < 0.3 * flips


def test_every_flipped_bit_of_the_study_is_named(folder):
    draws, path = np.random.default_rng(0), folder / "study.json"
    whole = path.read_bytes()
    for _ in range(100):
        flipped(path, draws)
        try:
            assert ("study.json", CHANGED) in found(folder)
        except BadInput as problem:
            assert "study.json" in str(problem)  # noqa: PT017
        path.write_bytes(whole)


def test_pictures_and_page_have_checksums_too(folder):
    draw("overview", Results(folder))
    write_report(folder, Path("report"))
    assert examine(folder).findings == []
    pictures = [folder / f"figures/overview.{kind}" for kind in ("svg", "png", "json")]
    page = [folder / f"report/{name}" for name in ("index.html", "runs.csv", "evidence.csv")]
    for path in (*pictures, *page):
        flipped(path, np.random.default_rng(0))
    assert {finding.path for finding in examine(folder).findings} == {*pictures, *page}
    for path in page:
        path.unlink()
    assert {what for path, what in found(folder) if path.startswith("report/")} == {"missing"}


@pytest.mark.parametrize("table", ["runs", "cells", "verdicts", "evidence"])
@pytest.mark.parametrize("how", ["other columns", "no rows", "another study's", "as before, twice"])
def test_a_table_that_was_replaced_is_named(folder, table, how):
    path = folder / f"tables/{table}.parquet"
    frame = pd.read_parquet(path)
    if how == "other columns":
        frame = pd.DataFrame({"x": [1, 2]})
    elif how == "no rows":
        frame = frame.iloc[:0]
    elif how == "another study's":
        frame = frame.iloc[:2]
    frame.to_parquet(path)
    assert found(folder) == [(f"tables/{table}.parquet", CHANGED)]
    resealed(folder, "tables" if table in ("runs", "cells") else "verdicts")
    if how == "as before, twice":  # written anew, the same
        assert found(folder) == []
    else:
        ((place, what),) = found(folder)
        assert place == f"tables/{table}.parquet"
        assert what.startswith(
            ("is not what its runs come to", "is no such table", "balancing/idle/alpha-none: is in")
        )


@pytest.mark.parametrize(
    ("table", "column", "value"),
    [("verdicts", "verdict", "reproduced"), ("runs", "falls", 0), ("cells", "falls_mean", 0.0), ("evidence", "estimate", 0.5)],
)  # fmt: skip
@pytest.mark.parametrize("sealed_again", [False, True])
def test_a_table_that_was_edited_is_named(folder, table, column, value, sealed_again):
    path = folder / f"tables/{table}.parquet"
    frame = pd.read_parquet(path)
    frame[column] = value
    frame.to_parquet(path)
    if sealed_again:
        resealed(folder, "tables" if table in ("runs", "cells") else "verdicts")
    ((place, what),) = found(folder)
    assert place == f"tables/{table}.parquet"
    assert what.startswith(f"is not what its runs come to: row 0 has {column}") == sealed_again


def test_verdicts_by_other_claims_are_a_note(folder, tmp_path):
    claims = tmp_path / "claims.yaml"
    text = Path("config/claims.yaml").read_text("utf-8")
    claims.write_text(text.replace("at_least: 0.98", "at_least: 0.97"), "utf-8")
    diagnosis = examine(folder, claims)
    assert diagnosis.findings == []
    assert any("were not judged again" in note for note in diagnosis.notes)


def test_verdicts_are_judged_again_with_what_the_readings_said(folder):
    claims = load_claims(Path("config/claims.yaml"))
    said = dict.fromkeys(OVER_READINGS, 0.9) | {"grade": "depends on the reading"}
    verdicts = write_verdicts(Results(folder), claims, {"C1": said, "C16": said})
    assert examine(folder).findings == []
    verdicts.loc[verdicts["claim"] == "C16", "weighted_share"] = 0.97
    verdicts.to_parquet(folder / "tables/verdicts.parquet")
    resealed(folder, "verdicts")
    assert found(folder) == [
        ("tables/verdicts.parquet", "is not what its runs come to: row 15 has weighted_share 0.97 in place of 0.9")
    ]  # fmt: skip


def test_what_has_no_checksum_is_named(folder):
    (folder / "tables/mine.parquet").write_bytes(b"mine")
    ledger = ledger_path(folder, RUN)
    ledger.unlink()
    words = dict(found(folder))
    assert words["tables/mine.parquet"].startswith("has no checksum in")
    assert words[str(ledger.relative_to(folder))].startswith("missing")
    shutil.rmtree(folder / LEDGERS)
    assert [place for place, _ in found(folder)] == [LEDGERS]


def test_logs_and_a_study_below_are_not_looked_at(folder):
    (folder / "logs").mkdir()
    (folder / "logs/tables.log").write_text("said", "utf-8")
    (folder / "smoke/tables").mkdir(parents=True)
    (folder / "smoke/study.json").write_text("{}", "utf-8")
    (folder / "smoke/tables/runs.parquet").write_bytes(b"another's")
    assert found(folder) == []


def test_a_missing_table_is_found(folder):
    (folder / "tables/verdicts.parquet").unlink()
    assert found(folder) == [("tables/verdicts.parquet", "missing")]


def test_a_run_of_another_specification_is_found(folder):
    other = folder / "runs/balancing/table/alpha-1/seed-1.windows.parquet"
    shutil.copy(other, folder / f"{RUN}.windows.parquet")
    assert found(folder) == [(f"{RUN}.windows.parquet", CHANGED)]
    resealed(folder, RUN)
    ((place, what),) = found(folder)
    assert place == f"{RUN}.windows.parquet"
    assert what.startswith("is of another specification")


def test_orphans_are_named_and_deleted_and_nothing_else(folder, capsys):
    gone = folder / "runs/balancing/table/alpha-0.3"
    shutil.copytree(folder / "runs/balancing/table/alpha-0.1", gone)
    left = folder / "runs/balancing/table/alpha-0.1/.seed-1.rrd.123.part"
    left.write_bytes(b"half")
    assert len(examine(folder).orphans) == 3 * 4 + 1
    assert main(["doctor", str(folder)]) == 0
    assert "13 files are of no run of the study" in capsys.readouterr().out
    assert main(["clean-orphans", str(folder)]) == 0
    listed = capsys.readouterr().out.splitlines()
    assert listed[:13] == [str(path) for path in examine(folder).orphans]
    assert listed[13].endswith("nothing is deleted without --yes:")
    assert gone.exists()
    command = shlex.split(listed[14])
    assert command[0] == "upswing"
    assert main(command[1:]) == 0
    assert capsys.readouterr().out.splitlines() == [*listed[:13], "deleted 13 files"]
    assert not gone.exists()
    assert not left.exists()
    assert examine(folder).findings == []
    assert delete_orphans(folder) == []


def test_without_a_study_nothing_is_deleted(tmp_path):
    (tmp_path / "runs").mkdir()
    (tmp_path / "runs/mine.txt").write_text("mine", "utf-8")
    with pytest.raises(BadInput, match=r"study\.json"):
        delete_orphans(tmp_path)
    with pytest.raises(BadInput, match=r"study\.json"):
        examine(tmp_path)
    assert (tmp_path / "runs/mine.txt").exists()


def test_other_versions_are_a_note_and_no_fault(folder, monkeypatch):
    monkeypatch.setattr("upswing.analysis.doctor.version", lambda _: "0.0")
    diagnosis = examine(folder)
    assert diagnosis.findings == []
    assert any("12 runs were made with numpy" in note for note in diagnosis.notes)


def test_results_are_a_folder(tmp_path):
    with pytest.raises(BadInput):
        examine(Path(tmp_path / "nothing"))
