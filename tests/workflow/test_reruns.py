"""After an edit, exactly what it touches would be made again: Snakemake's own plan on a small study."""

import os
import re
import shutil
from pathlib import Path

import pandas as pd
import pytest
import yaml

from tests.workflow.small_study import FIGURES_OF_SMALL, SMALL, Edited, as_run
from upswing.analysis.doctor import delete_orphans, examine

CELLS = 5
COMPARISONS = 8  # of two tasks, and of the six claims whose cells are there
FOLLOWS = {
    "tables": 1,
    "verdicts": 1,
    "history": 1,
    "comparison": COMPARISONS,
    "figure": FIGURES_OF_SMALL,
    "viewer": 1,
    "report": 1,
}
TRAIN = "train_seeds_0_to_1"
# What follows from some cells: the figures that show them, the recordings of their tasks and claims.
OF_NETWORKS = {**FOLLOWS, "figure": 4, "comparison": 4}
OF_BALANCING = {**FOLLOWS, "figure": 5, "comparison": 6}
OF_TABLES = {**FOLLOWS, "comparison": COMPARISONS - 1}  # one shows networks alone
OF_A_CLAIM = {"verdicts": 1, "history": 1, "figure": 1, "comparison": 1, "viewer": 1, "report": 1}
OF_A_NEW_CELL = {**FOLLOWS, "figure": 3, "comparison": 1}


@pytest.fixture(scope="module")
def done(once, tmp_path_factory):
    """A study that has been run."""
    study = as_run(once, tmp_path_factory.mktemp("done"), Edited)
    assert study.plan() == {}
    return study


@pytest.fixture
def study(done):
    """The same, put back afterwards."""
    kept = {
        path: (path.read_bytes(), path.stat())
        for folder in ("src", "config", "report", "workflow")
        for path in (done.folder / folder).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }
    yield done
    for path, (content, stat) in kept.items():
        if (
            not path.exists()
            or path.read_bytes() != content
            or path.stat().st_mtime != stat.st_mtime
        ):
            path.write_bytes(content)
            os.utime(path, (stat.st_atime, stat.st_mtime))


U = "src/upswing/"


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (U + "physics/pendulum.py", '"""The constants of §4.2.2, and', '# a comment\n    """Constants, and', {}),
        (U + "runs/loop.py", "# Observe starting state s", "# observe", {}),
        (U + "report/words.py", "UNKNOWN = ", "\n\nUNKNOWN    = ", {}),
        (U + "agents/learners/backpropagation/one_hidden.py", "STALE = -1", "STALE = -2", {TRAIN: 1, **OF_NETWORKS}),
        (U + "agents/learners/table.py", "+= share", "+= share * 1.0", {TRAIN: 2, **OF_TABLES}),
        # A new option of one learner.
        (U + "agents/learners/networks.py", "    def check(", "    slope: float = 1.0\n\n    def check(", {TRAIN: 1, "study": 1, **OF_NETWORKS}),
        (U + "physics/pendulum.py", "gravity: float = 9.81", "gravity: float = 9.80", {TRAIN: CELLS, **FOLLOWS}),
        (U + "agents/features/grid.py", "from math import floor, pi", "from math import floor, pi\nX = 1", {TRAIN: CELLS, **FOLLOWS}),
        (U + "figures/fig05.py", "5_000", "4_000", {"figure": 1, "viewer": 1, "report": 1}),
        (U + "report/words.py", 'UNKNOWN = "–"', 'UNKNOWN = "-"', {"report": 1}),
        (U + "runs/recording/layout.py", "row_shares=[2, 3]", "row_shares=[3, 3]", {"comparison": COMPARISONS, "viewer": 1}),
        ("report/parts/head.html.j2", "run again", "done again", {"report": 1}),
        ("report/style.css", "1.05rem" , "1.06rem", None),
        ("report/viewer.html", "← the report", "← back", {"viewer": 1}),
        ("config/claims.yaml", "at_least: 0.98", "at_least: 0.97", {"verdicts": 1, "history": 1, "report": 1}),
        # A claim with a figure and a recording, which show what decides it.
        ("config/claims.yaml", "at_most: 0.25", "at_most: 0.24", OF_A_CLAIM),
        (U + "figures/panels.py", "linewidth=1.8", "linewidth=1.7", {"figure": FIGURES_OF_SMALL, "viewer": 1, "report": 1}),
        ("config/claims.yaml", "C1:\n", "# a comment\nC1:\n", {}),
        ("workflow/rules/train.smk", "# Training:", "# The training:", {}),
    ],
)  # fmt: skip
def test_an_edit_reruns_what_it_touches(study, file, old, new, expected):
    if expected is None:
        old, new, expected = ".lead {", ".lead  {", {"report": 1}
    study.edit(file, old, new)
    assert study.plan() == expected


def changed(**more):
    return {**SMALL, "seeds": 2, **more}


def with_experiments(first_alphas):
    experiments = [dict(experiment) for experiment in SMALL["experiments"]]
    experiments[0]["alphas"] = first_alphas
    return changed(experiments=experiments)


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (changed(), {}),
        ("# a comment\n" + yaml.safe_dump(changed()), {}),
        # A claim whose recording is there names it.
        (with_experiments([1, 0.5]), {TRAIN: 2, "study": 1, **OF_A_NEW_CELL, "comparison": 2}),
        (with_experiments([0.5]), None),
        (changed(seeds=4), {"train_seeds_2_to_3": CELLS, "study": 1, **FOLLOWS}),
        (changed(readings={"learning_rate": 0.1}), {TRAIN: 1, "study": 1, **OF_NETWORKS}),
        (changed(readings={"reset": "terminal"}), {TRAIN: 2, "study": 1, **OF_BALANCING}),
        (changed(epsilon=0.02), {TRAIN: CELLS, "study": 1, **FOLLOWS}),
        # The same cells in another order: what shows whatever there is shows them in that order.
        (changed(experiments=SMALL["experiments"][::-1]), {"study": 1, "tables": 1, "history": 1, "figure": 3, "comparison": 1, "viewer": 1, "report": 1}),
        # Two values swapped: a set of both is the same, a specification is not.
        (changed(epsilon=0.7, discount=0.01), {TRAIN: CELLS, "study": 1, **FOLLOWS}),
        (changed(tasks={name: {**task, "steps": 7_000} if name == "balancing" else task for name, task in SMALL["tasks"].items()}), {TRAIN: 2, "study": 1, **OF_BALANCING}),
    ],
)  # fmt: skip
def test_a_change_of_the_configuration_reruns_what_it_touches(study, content, expected):
    study.write(content)
    planned = study.plan()
    if expected is None:  # other cells: figures 5 and 7 lose theirs
        assert planned.pop("figure") < FIGURES_OF_SMALL
        expected = {TRAIN: 2, "study": 1, **OF_A_NEW_CELL}
        expected.pop("figure")
    assert planned == expected


def test_an_architecture_is_new_cells(study):
    architectures = {**SMALL["architectures"], "networks-3": {"learner": "networks", "hidden": [3]}}
    experiments = [
        *SMALL["experiments"],
        {"tasks": ["balancing"], "architectures": ["networks-3"], "alphas": [1]},
    ]
    study.write(changed(architectures=architectures, experiments=experiments))
    planned = {TRAIN: 1, "study": 1, **OF_A_NEW_CELL}
    planned.pop("verdicts")  # no claim is about it
    assert study.plan() == planned


def test_another_version_of_what_computes_trains_anew(study, tmp_path):
    # A copy of numpy's metadata that says another version, found first.
    import importlib.metadata

    place = Path(importlib.metadata.distribution("numpy")._path)
    fake = tmp_path / place.name
    fake.mkdir()
    text = (place / "METADATA").read_text("utf-8")
    (fake / "METADATA").write_text(
        re.sub(r"^Version: .*", "Version: 0.0.1", text, flags=re.M), "utf-8"
    )
    assert study.plan(versions=f"{tmp_path}:") == {TRAIN: CELLS, **FOLLOWS}


def test_a_deleted_output_is_made_again_and_what_follows(study):
    path = study.folder / "results/runs/balancing/table/alpha-1/seed-1.trajectory.parquet"
    content, stat = path.read_bytes(), path.stat()
    path.unlink()
    assert study.plan()[TRAIN] == 1
    path.write_bytes(content)
    os.utime(path, (stat.st_atime, stat.st_mtime))
    figure = study.folder / "results/figures/fig05.svg"
    content, stat = figure.read_bytes(), figure.stat()
    figure.unlink()
    assert study.plan() == {"figure": 1, "viewer": 1, "report": 1}
    figure.write_bytes(content)
    os.utime(figure, (stat.st_atime, stat.st_mtime))
    assert study.plan() == {}


def test_results_copied_with_other_times_train_nothing(done, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(done.folder, copy, copy_function=shutil.copy)
    study = object.__new__(Edited)
    study.folder = copy
    assert TRAIN not in study.plan()


def test_without_snakemakes_memory_nothing_is_trained_anew(done, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(done.folder, copy, ignore=shutil.ignore_patterns(".snakemake"))
    study = object.__new__(Edited)
    study.folder = copy
    assert study.plan() == {"study": 1, **FOLLOWS}
    # What a run was made from stands with the run.
    study.edit(U + "agents/learners/table.py", "+= share", "+= share * 1.0")
    assert study.plan() == {TRAIN: 2, "study": 1, **FOLLOWS}


def test_a_recording_that_the_viewer_lost_comes_back(done, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(done.folder, copy)
    study = object.__new__(Edited)
    study.folder = copy
    recordings = copy / "results/report/viewer/recordings"
    lost, kept = sorted(recordings.iterdir())[:2]
    content, written = lost.read_bytes(), kept.stat().st_mtime_ns
    lost.unlink()
    assert study.plan() == {"viewer": 1}
    assert study.snakemake().returncode == 0
    assert lost.read_bytes() == content
    assert kept.stat().st_mtime_ns == written  # what was right stays
    assert study.plan() == {}


def test_runs_of_a_removed_alpha_are_named_and_deleted(done, tmp_path):
    copy = tmp_path / "copy"
    shutil.copytree(done.folder, copy)
    study = object.__new__(Edited)
    study.folder = copy
    smaller = changed(experiments=SMALL["experiments"][:1] + SMALL["experiments"][2:])
    study.write(smaller)
    assert study.snakemake("--", "results/tables/runs.parquet").returncode == 0
    planned = study.plan()
    assert planned.keys() <= FOLLOWS.keys() - {"tables"}
    orphans = examine(copy / "results").orphans
    assert {str(path.relative_to(copy / "results/runs")).split("/seed")[0] for path in orphans} == {
        "full-control/table/alpha-0.001"
    }
    assert len(orphans) == 2 * 4
    assert delete_orphans(copy / "results") == orphans
    assert study.plan() == planned


@pytest.mark.heavy
def test_two_runs_from_nothing_and_one_core_or_two_give_the_same_tables(done, tmp_path):
    alone = Edited(tmp_path)
    finished = alone.snakemake("--cores", "1")
    assert finished.returncode == 0, finished.stdout + finished.stderr
    differ = ["seconds", "steps_per_second", "git_commit", "dirty", "steps_per_second_median"]
    for name in ("runs", "cells", "verdicts", "evidence"):
        one, other = (
            pd.read_parquet(study.folder / f"results/tables/{name}.parquet")
            for study in (alone, done)
        )
        kept = [column for column in one.columns if column not in differ]
        pd.testing.assert_frame_equal(one[kept], other[kept])
    weights = [
        sorted((study.folder / "results/runs").rglob("*.safetensors")) for study in (alone, done)
    ]
    for one, other in zip(*weights, strict=True):
        assert one.read_bytes() == other.read_bytes()
