"""The targets of make: each is about the study in CONFIG and the results in RESULTS."""

import os
import re
import subprocess

import pytest

from tests.paths import ROOT
from tests.workflow.small_study import BIN

OF_A_STUDY = {
    "reproduce",
    "slurm",
    "unlock",
    "study",
    "readings",
    "exploratory",
    "snakemake-report",
}
"""What runs Snakemake on the study in CONFIG."""

OF_RESULTS = {
    "browse", "doctor", "clean-orphans", "screenshots", "readme", "site", "notebook", "bench",
    "bench-edits", "bench-growth", "clean",
}  # fmt: skip
"""What looks at a folder of results."""

OF_OTHER_STUDIES = {"smoke", "beyond"}
OF_THE_CODE = {
    "help", "install", "test", "test-heavy", "test-all", "audit", "lint", "types", "format", "schema",
    "docs", "lock", "portability",
}  # fmt: skip


def said(target, *given):
    """What make would run, without the installation."""
    kept = {key: text for key, text in os.environ.items() if key not in ("CONFIG", "RESULTS")}
    done = subprocess.run(
        ["make", "--no-print-directory", "--dry-run", "--assume-old=.venv/.installed", target, *given],
        cwd=ROOT, env=kept, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return done.stdout


def test_every_target_is_known_here():
    text = (ROOT / "Makefile").read_text("utf-8")
    targets = set(re.findall(r"^([a-z-]+):.* ## ", text, re.MULTILINE))
    assert targets == OF_A_STUDY | OF_RESULTS | OF_OTHER_STUDIES | OF_THE_CODE


@pytest.mark.parametrize("target", sorted(OF_A_STUDY))
def test_what_runs_a_study_takes_its_configuration_and_another_folder(target):
    lines = said(target, "CONFIG=config/smoke.yaml", "RESULTS=a folder")
    assert "config/smoke.yaml" in lines
    assert "config/config.yaml" not in lines
    assert '--config results="a folder"' in lines
    assert "--config results" not in said(target, "CONFIG=config/smoke.yaml")


@pytest.mark.parametrize("target", sorted(OF_RESULTS))
def test_what_looks_at_results_takes_their_folder_or_their_study(target):
    assert 'results="a folder"' in said(target, "RESULTS=a folder")
    asking = 'results=$(.venv/bin/upswing check "config/smoke.yaml" --folder)'
    assert asking in said(target, "CONFIG=config/smoke.yaml")
    assert re.search(r"^results=results &&", said(target), re.MULTILINE)


@pytest.mark.parametrize("target", sorted(OF_OTHER_STUDIES))
def test_the_other_studies_of_the_project_take_another_folder(target):
    assert '--config results="a folder"' in said(target, "RESULTS=a folder")


def test_orphans_are_deleted_where_that_is_said():
    assert "--yes" not in said("clean-orphans")
    assert "--yes" in said("clean-orphans", "YES=1")


def test_the_folder_of_a_study_is_said_and_checked():
    def check(*words):
        return subprocess.run(
            [BIN / "upswing", "check", *words], cwd=ROOT, capture_output=True, text=True, check=False
        )  # fmt: skip

    assert check("config/smoke.yaml", "--folder").stdout == "results/smoke\n"
    assert check("config/smoke.yaml", "--folder", "--results", "results/x").stdout == "results/x\n"
    refused = check("config/smoke.yaml", "--results", "src")
    assert refused.returncode == 2
    assert '--config: results: "src": is in src/' in refused.stderr


def test_only_results_are_removed(tmp_path):
    (tmp_path / "mine.txt").touch()
    done = subprocess.run(
        ["make", "clean", f"RESULTS={tmp_path}"], cwd=ROOT, capture_output=True, text=True, check=False
    )  # fmt: skip
    assert done.returncode != 0
    assert f"upswing: {tmp_path}: is not the results of a study" in done.stderr
    assert (tmp_path / "mine.txt").exists()


def test_in_a_pipe_there_are_no_bars():
    assert "--logger" not in said("reproduce")
