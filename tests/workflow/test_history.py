"""The history with the real Snakemake: an entry for what came out otherwise, and none for anything else."""

import os
import re
import shutil
import subprocess

import pytest

from tests.paths import ROOT
from tests.workflow.small_study import BIN, SMALL, Study, surroundings
from upswing.analysis.doctor import examine
from upswing.analysis.history.read import entries
from upswing.study.history_paths import ENTRIES, NOTE, folder_of

pytestmark = pytest.mark.heavy  # it runs a study again and again

ONE = {**SMALL, "experiments": SMALL["experiments"][:1]}
"""Two cells, of which one will get another α."""

WITH_AN_ALPHA = {**ONE, "experiments": [{**SMALL["experiments"][0], "alphas": [1, 0.5]}]}


def upswing(study, *words, **more):
    return subprocess.run(
        [BIN / "upswing", *words], cwd=study.folder, env={**surroundings(), **more},
        capture_output=True, text=True, check=False,
    )  # fmt: skip


def make(study, *words, **more):
    """``make`` in the study's folder, with the programs of this environment."""
    return subprocess.run(
        ["make", "--no-print-directory", "--old-file=install", f"BIN={BIN}", *words],
        cwd=study.folder, env={**surroundings(), **more}, capture_output=True, text=True, check=False,
    )  # fmt: skip


def entries_of(study):
    return entries(study.folder / "results")


def content(study, entry):
    """All that an entry holds, and when its files were written."""
    folder = study.folder / "results" / folder_of(entry.id)
    return {path.name: (path.read_bytes(), path.stat().st_mtime_ns) for path in folder.iterdir()}


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A study that ran once, with a note."""
    study = Study(tmp_path_factory.mktemp("history"))
    shutil.copy(ROOT / "Makefile", study.folder)
    study.write(ONE)
    done = make(study, "study", "CONFIG=config/small.yaml", "NOTE=the first try, it costs $5")
    assert done.returncode == 0, done.stdout + done.stderr
    study.said = done
    return study


def test_the_beginning_says_what_is_to_come_and_the_end_where_the_page_is(study):
    said = study.said.stdout + study.said.stderr
    assert re.search(r"^results: none is there, 4 are to be trained: about \d+ s on", said, re.M)
    *_, kept, last = study.said.stdout.splitlines()
    assert kept.startswith("The note is kept with @1 (")
    assert last == "The report is at results/report/index.html"


def test_a_study_leaves_an_entry_with_its_note_and_what_it_took(study):
    (entry,) = entries_of(study)
    assert (entry.number, entry.before, entry.note) == (1, None, "the first try, it costs $5")
    assert (entry.runs.all, entry.cells, entry.taken.trained_runs) == (4, 2, 4)
    assert entry.taken.training_seconds > 0
    assert entry.verdicts["C16"] == "reproduced"
    diagnosis = examine(study.folder / "results")
    assert diagnosis.findings == []


def test_a_no_op_adds_nothing_and_makes_nothing_and_its_note_is_not_lost_without_a_word(study):
    (entry,) = entries_of(study)
    before = content(study, entry)
    listed = (study.folder / "results" / ENTRIES).stat().st_mtime_ns
    page = (study.folder / "results/report/index.html").stat().st_mtime_ns
    assert study.jobs() == {}
    done = make(study, "study", "CONFIG=config/small.yaml", "NOTE=why not")
    assert done.returncode == 0, done.stderr
    assert "all 4 runs are there, none is to be trained" in done.stderr
    assert "Nothing changed, so no entry of the history was written" in done.stdout
    assert "upswing history note @last" in done.stdout
    assert [one.id for one in entries_of(study)] == [entry.id]
    assert content(study, entry) == before
    assert (study.folder / "results" / ENTRIES).stat().st_mtime_ns == listed
    assert (study.folder / "results/report/index.html").stat().st_mtime_ns == page


def test_a_note_that_is_no_line_stops_a_study_before_it_begins(study):
    done = make(study, "study", "CONFIG=config/small.yaml", "NOTE=" + "x" * 501)
    assert done.returncode != 0
    assert "NOTE: " in done.stderr
    assert "a note has at most 500" in done.stderr
    assert "The report is at" not in done.stdout


def test_a_job_that_comes_to_the_same_adds_nothing(study):
    (entry,) = entries_of(study)
    before = content(study, entry)
    (study.folder / "results/tables/verdicts.parquet").unlink()
    assert study.jobs() == {"verdicts": 1, "history": 1, "report": 1}
    assert [one.id for one in entries_of(study)] == [entry.id]
    assert content(study, entry) == before
    log = (study.folder / "results/logs/history.log").read_text("utf-8")
    assert f"nothing came out otherwise than in @1 ({entry.id}): no entry was written" in log


def test_an_edit_is_named_with_the_verdicts_that_changed(study):
    first = content(study, entries_of(study)[0])
    claims = study.folder / "config/claims.yaml"
    text = claims.read_text("utf-8")
    before, of_c16 = text.split("\nC16:\n")
    claims.write_text(
        f"{before}\nC16:\n{of_c16.replace('at_least: 0.98', 'at_least: 0.999')}", "utf-8"
    )
    study.write(WITH_AN_ALPHA)
    done = study.snakemake()
    assert done.returncode == 0, done.stdout + done.stderr
    one, two = entries_of(study)
    assert content(study, one) == first
    assert two.before == one.id
    assert {(row.what, row.before, row.after) for row in two.configuration} == {
        ("experiments[balancing: table, networks-5].alphas", "[1]", "[1, 0.5]"),
        ("claims.C16.parts[0].at_least", "0.98", "0.999"),
    }
    assert [(row.what, row.before) for row in two.changed_verdicts] == [("C16", "reproduced")]
    assert (two.runs.all, two.runs.new, two.runs.changed, two.taken.trained_runs) == (8, 4, 0, 4)
    said = upswing(study, "history").stdout
    assert "experiments[balancing: table, networks-5].alphas: [1] → [1, 0.5]" in said
    assert "claims.C16.parts[0].at_least: 0.98 → 0.999" in said
    after = two.verdicts["C16"]
    assert f"C16: reproduced → {after}" in said
    assert said.index("@2") < said.index("@1")
    page = (study.folder / "results/report/index.html").read_text("utf-8")
    assert f'<span class="hidden">{after}</span>' in page[page.index('id="history"') :]
    assert study.jobs() == {}


def test_entries_and_the_folder_are_compared(study):
    done = upswing(study, "compare", "@1", "@last", "results")
    assert done.returncode == 1, done.stderr
    said = done.stdout
    assert "experiments[balancing: table, networks-5].alphas: [1] → [1, 0.5] → [1, 0.5]" in said
    assert "2 cells are only in B and C" in said
    assert "2 of 2 cells that all have are the same" in said
    assert "0 of 4 runs that all have are not identical" in said
    assert said.index("alphas: ") < said.index("cells that all") < said.index("C16: reproduced →")
    assert upswing(study, "compare", "@2", "results").returncode == 0


def test_without_snakemakes_memory_no_entry_is_added(study, tmp_path):
    before = [one.id for one in entries_of(study)]
    copy = study.copied(tmp_path / "copy")
    shutil.rmtree(copy.folder / ".snakemake")
    assert copy.jobs("--", f"results/{ENTRIES}")["history"] == 1
    assert [one.id for one in entries_of(copy)] == before


def test_a_note_to_an_entry_comes_onto_the_page_and_makes_nothing_else(study):
    assert upswing(study, "history", "note", "@1", "seen <again>").returncode == 0
    assert study.jobs() == {"report": 1}
    page = (study.folder / "results/report/index.html").read_text("utf-8")
    assert "<em>seen &lt;again&gt;</em>" in page


def test_a_note_in_the_environment_makes_nothing_run(study):
    os.environ[NOTE] = "another"
    try:
        assert study.jobs() == {}
    finally:
        del os.environ[NOTE]


def test_make_clean_keeps_the_history(study):
    results = study.folder / "results"
    git = ["git", "-C", str(study.folder), "-c", "user.name=x", "-c", "user.email=x@example.org"]
    (results / "README.md").write_text("…", "utf-8")
    for words in (["init", "-q"], ["add", "-f", "results/README.md"], ["commit", "-qm", "x"]):
        subprocess.run([*git, *words], check=True, capture_output=True)
    before = {one.id: content(study, one) for one in entries_of(study)}
    done = make(study, "clean")
    assert done.returncode == 0, done.stderr
    assert {one.id: content(study, one) for one in entries_of(study)} == before
    assert {path.name for path in results.iterdir()} == {"README.md", "checksums", "history"}
    assert {path.name for path in (results / "checksums").iterdir()} == {"history"}
