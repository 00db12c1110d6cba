"""A folder of results is looked through: what is whole, damaged, missing, left over."""

import shutil
from pathlib import Path

import pandas as pd
import pytest

from upswing.cli import main
from upswing.doctor import delete_orphans, examine
from upswing.matrix import RUN_FILES
from upswing.problems import BadInput

pytestmark = pytest.mark.xdist_group("recordings")
RUN = "runs/balancing/table/alpha-0.1/seed-1"


@pytest.fixture
def folder(results, tmp_path):
    """A copy of a small study's results, to damage."""
    copy = tmp_path / "results"
    shutil.copytree(results.folder, copy, ignore=shutil.ignore_patterns("report", "figures"))
    return copy


def found(folder):
    return [(str(f.path.relative_to(folder)), f.what) for f in examine(folder).findings]


def test_whole_results_are_said_to_be_whole(folder, capsys):
    diagnosis = examine(folder)
    assert diagnosis.findings == []
    assert diagnosis.orphans == []
    assert (diagnosis.runs, diagnosis.files) == (12, 48)
    assert main(["doctor", str(folder)]) == 0
    assert "12 runs, 48 files: all whole" in capsys.readouterr().out


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
    if (kind, accident) == ("windows.parquet", "flipped"):
        # The windows know the other files' checksums; a bit in their own columns shows if it breaks them.
        assert all(f.path == path for f in examine(folder).findings)
        return
    findings = [f for f in examine(folder).findings if f.path == path]
    assert len(findings) == 1
    assert main(["doctor", str(folder)]) == 1
    said = capsys.readouterr().out
    assert str(path) in said
    assert "run the study again" in said
    assert accident == "missing" or f"rm '{path}'" in said


def test_a_row_of_another_run_is_found(folder):
    path = folder / "tables/runs.parquet"
    runs = pd.read_parquet(path)
    runs.loc[3, "digest"] = "0" * 16
    runs.iloc[:-1].to_parquet(path)
    words = [what for _, what in found(folder)]
    assert any("the row is not of the run that is there" in what for what in words)
    assert any("has no row" in what for what in words)


def test_unreadable_and_missing_tables_are_found(folder):
    (folder / "tables/cells.parquet").write_bytes(b"PAR1 nonsense")
    (folder / "tables/verdicts.parquet").unlink()
    places = dict(found(folder))
    assert places["tables/cells.parquet"].startswith("cannot be read")
    assert places["tables/verdicts.parquet"] == "missing"


def test_a_run_of_another_specification_is_found(folder):
    other = folder / "runs/balancing/table/alpha-1/seed-1.windows.parquet"
    shutil.copy(other, folder / f"{RUN}.windows.parquet")
    assert any("is of another specification" in what for _, what in found(folder))


def test_orphans_are_named_and_deleted_and_nothing_else(folder, capsys):
    gone = folder / "runs/balancing/table/alpha-0.3"
    shutil.copytree(folder / "runs/balancing/table/alpha-0.1", gone)
    left = folder / "runs/balancing/table/alpha-0.1/.seed-1.rrd.123.part"
    left.write_bytes(b"half")
    assert len(examine(folder).orphans) == 3 * 4 + 1
    assert main(["doctor", str(folder)]) == 0
    assert "13 files are of no run of the study" in capsys.readouterr().out
    assert main(["clean-orphans", str(folder)]) == 0
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
    monkeypatch.setattr("upswing.doctor.version", lambda _: "0.0")
    diagnosis = examine(folder)
    assert diagnosis.findings == []
    assert any("12 runs were made with numpy" in note for note in diagnosis.notes)


def test_results_are_a_folder(tmp_path):
    with pytest.raises(BadInput):
        examine(Path(tmp_path / "nothing"))
