"""`make readings` is one call of Snakemake: sweeps, what they come to, and after them the page that shows it."""

import os
import re
import shutil
import subprocess

import pytest
import yaml

from tests.paths import ROOT
from tests.workflow.small_study import BIN, Study

pytestmark = pytest.mark.heavy  # it runs studies with sweeps, or beyond the thesis

STUDY = {
    "results": "results",
    "seeds": 2,
    "seeds_per_job": 2,
    "tasks": {"balancing": {"kind": "balancing", "steps": 2_000}},
    "architectures": {
        "table": {"learner": "table"},
        "random": {"learner": "control", "behaviour": "random"},
    },
    "experiments": [
        {"tasks": ["balancing"], "architectures": ["table"], "alphas": [1, 0.001]},
        {"tasks": ["balancing"], "architectures": ["random"]},
    ],
}
CELLS = ["balancing/table/alpha-1", "balancing/table/alpha-0.001", "balancing/random/alpha-none"]
SWEEPS = {"tables": {"vary": ["ties", "first_q"], "how": "pairs", "seeds": 1, "cells": CELLS}}
TARGETS = ("--", "with_readings")
SNAKEMAKE = """#!/bin/sh
echo "$@" >> calls.txt
exec "{bin}/snakemake" "$@"
"""


class Checkout(Study):
    """A study that is run by `make`, with a note of each call of Snakemake."""

    def __init__(self, folder):
        super().__init__(folder)
        shutil.copy(ROOT / "Makefile", folder)
        (folder / "config/readings.yaml").write_text(yaml.safe_dump(SWEEPS), "utf-8")
        programs = folder / "venv/bin"
        programs.mkdir(parents=True)
        (programs / "snakemake").write_text(SNAKEMAKE.format(bin=BIN), "utf-8")
        (programs / "snakemake").chmod(0o755)
        (programs / "upswing").symlink_to(BIN / "upswing")
        self.write(STUDY)

    def write(self, content):
        super().write(content)
        shutil.copy(self.folder / "config/small.yaml", self.folder / "config/config.yaml")

    def make(self, target):
        """Make a target; returns the calls of Snakemake that this took."""
        calls = self.folder / "calls.txt"
        calls.unlink(missing_ok=True)
        done = subprocess.run(
            ["make", "-o", "install", "VENV=venv", "CORES=2", target],
            cwd=self.folder, capture_output=True, text=True, check=False,
            env={name: value for name, value in os.environ.items() if name != "MAKEFLAGS"},
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
        return calls.read_text("utf-8").splitlines()

    @property
    def sweeps(self):
        """The tables of the sweeps."""
        return sorted((self.folder / "results/readings").rglob("*.parquet"))

    def times(self):
        """When each file of the results was written."""
        results = (self.folder / "results").rglob("*")
        return {path: path.stat().st_mtime_ns for path in results if path.is_file()}


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A study with its readings, made from nothing."""
    study = Checkout(tmp_path_factory.mktemp("readings"))
    study.calls = study.make("readings")
    return study


def test_all_of_it_is_one_call(study):
    assert len(study.calls) == 1
    assert len(study.sweeps) > 1
    assert (study.folder / "results/tables/robust.parquet").is_file()


def test_the_page_comes_after_the_sweeps_and_shows_them(study):
    page = (study.folder / "results/report/index.html").read_text("utf-8")
    shown = re.search(r'id="robust".*?</table>', page, re.DOTALL)[0]
    assert 'href="#C1"' in shown
    assert 'id="readings-tables"' in page


@pytest.mark.parametrize("how", ["make readings", "make reproduce"])
def test_afterwards_nothing_is_left_to_do(study, how):
    before = study.times()
    assert len(study.make(how.split()[1])) == 1
    assert study.times() == before


def changed(**more):
    return {**STUDY, **more}


@pytest.mark.parametrize(
    ("content", "trained"),
    [
        (changed(seeds=4), {"train_seeds_2_to_3": 3}),
        (
            changed(experiments=[*STUDY["experiments"], {"tasks": ["balancing"], "architectures": ["table"], "alphas": [0.5]}]),
            {"train_seeds_0_to_1": 1},
        ),
    ],
    ids=["a seed", "a cell"],
)  # fmt: skip
def test_what_is_new_in_the_study_neither_sweeps_nor_judges_the_sweeps_again(
    study, content, trained
):
    study.write(content)
    planned = study.jobs("--dry-run", *TARGETS)
    study.write(STUDY)
    assert planned.items() >= {**trained, "study": 1, "report": 1}.items()
    assert not {"sweep", "readings"} & planned.keys()


@pytest.mark.parametrize(
    "content",
    [
        changed(epsilon=0.02),
        changed(epsilon=0.02, seeds=4),
        changed(readings={"reset": "terminal"}),
    ],
    ids=["an ε", "an ε and a seed", "a reading that is not varied"],
)
def test_what_a_sweep_depends_on_sweeps_again_in_the_same_call(study, content):
    """So it does while the file of the study is to be made anew, as it is here."""
    study.write(content)
    planned = study.jobs("--dry-run", *TARGETS)
    study.write(STUDY)
    assert planned["sweep"] == len(study.sweeps)
    assert planned["study"] == 1


def test_a_plain_run_keeps_the_page_with_its_readings(study):
    (study.folder / "results/report/index.html").unlink()
    assert study.jobs() == {"report": 1}
    test_the_page_comes_after_the_sweeps_and_shows_them(study)


def test_a_deleted_sweep_is_made_again_and_what_follows(study):
    study.sweeps[0].unlink()
    assert study.jobs("--dry-run", *TARGETS) == {
        "sweep": 1, "readings": 1, "verdicts": 1, "history": 1, "report": 1,
    }  # fmt: skip
    assert study.jobs(*TARGETS)["sweep"] == 1
    assert len(study.sweeps) > 1


def test_a_plain_run_leaves_sweeps_of_older_code_as_they_are_and_the_page_says_so(study):
    """`make readings` renews them, and then the page says it no more."""
    swept = {path: path.stat().st_mtime_ns for path in study.sweeps}
    page = study.folder / "results/report/index.html"
    study.write(changed(epsilon=0.02))
    planned = study.jobs()
    assert planned["train_seeds_0_to_1"] == len(CELLS)
    assert not {"sweep", "finalists", "readings"} & planned.keys()
    assert {path: path.stat().st_mtime_ns for path in study.sweeps} == swept
    assert "changes to the sweep of tables;" in page.read_text("utf-8")
    assert study.jobs() == {}
    assert study.jobs(*TARGETS)["sweep"] == len(swept)
    assert "of an older state" not in page.read_text("utf-8")
    assert study.jobs() == study.jobs(*TARGETS) == {}


def test_a_plain_run_without_a_table_of_the_sweeps_makes_none_of_them(study):
    """It shows what is there; `make readings` makes the rest."""
    study.sweeps[0].unlink()
    assert study.jobs() == {}
    (study.folder / "results/tables/robust.parquet").unlink()
    assert not {"sweep", "readings"} & study.jobs().keys()
    assert not (study.folder / "results/tables/robust.parquet").exists()
    assert study.jobs(*TARGETS).items() >= {"sweep": 1, "readings": 1, "report": 1}.items()
