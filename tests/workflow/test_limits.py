"""What may be written and what must not: quoting, names, folders, numbers of runs."""

import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest
import yaml

from tests.paths import ROOT
from tests.workflow.small_study import SMALL, Study
from upswing.study.check import checked
from upswing.study.config import validated
from upswing.study.errors import BadInput
from upswing.study.ids import KNOWN_FILE, RUN_FILES
from upswing.study.matrix import Matrix
from upswing.study.names import alpha_text
from upswing.study.results_folder import check_results
from upswing.study.values import MOST_RUNS

CLAIMS = yaml.safe_load((ROOT / "config/claims.yaml").read_text("utf-8"))


RULES = [*(ROOT / "workflow/rules").glob("*.smk"), ROOT / "Snakefile"]


SHELL = re.compile(r'shell:\s+((?:"[^\n]*"\s*)+)')


def test_every_placeholder_of_every_command_is_quoted():
    rules = commands = 0
    for path in RULES:
        text = path.read_text("utf-8")
        rules += len(re.findall(r"^\s*rule\b", text, re.MULTILINE))
        for command in SHELL.findall(text):
            commands += 1
            bare = [one for one in re.findall(r"\{[^{}]*\}", command) if not one.endswith(":q}")]
            assert bare == [], f"{path.name}: {command}"
            assert command.strip().startswith('"{params.upswing:q} ')
    assert commands == rules - 2 >= 13  # `all` and `with_readings` have none


def test_names_that_would_be_commands_or_paths_are_refused_before_anything_runs(tmp_path):
    study = Study(tmp_path)
    for name in ("$(touch pwned)", "../../x", "a;touch pwned", "`touch pwned`"):
        sweeps = {name: {"vary": ["ties"], "how": "pairs", "seeds": 1, "cells": ["balancing/table/alpha-1"]}}  # fmt: skip
        (tmp_path / "config/readings.yaml").write_text(yaml.safe_dump(sweeps), "utf-8")
        done = study.snakemake("--", "readings")
        said = done.stdout + done.stderr
        assert done.returncode != 0
        assert "a name has small letters" in said
        assert "Traceback" not in said
    assert not [path for path in tmp_path.rglob("*pwned*") if ".snakemake" not in path.parts]
    assert not (tmp_path / "results").exists()


def test_braces_in_a_text_are_no_wildcard(tmp_path):
    study = Study(tmp_path)
    experiments = [{**SMALL["experiments"][0], "title": "before {seed} and {wildcards.x}"}]
    study.write({**SMALL, "experiments": experiments, "results": "results/deep"})
    claims = {"C1": {**CLAIMS["C1"], "statement": "As {task} says."}}
    (tmp_path / "config/claims.yaml").write_text(yaml.safe_dump(claims), "utf-8")
    done = study.snakemake("--", "results/deep/study.json")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "before {seed} and {wildcards.x}" in (tmp_path / "results/deep/study.json").read_text()
    assert study.snakemake("--dry-run").returncode == 0


@pytest.mark.parametrize(
    "folder",
    ["/", "..", ".", "src", ".git", "src/upswing", "file", "loop", "a\nb", "a{seed}", "", "full", "nowhere", "full/../src", "-x", "~/x", "s3://x", "a//b", "a/", "ours/tables", "ours/runs/a", "file/below"],
)  # fmt: skip
def test_a_folder_that_is_not_for_results_is_refused(tmp_path, monkeypatch, folder):
    monkeypatch.chdir(tmp_path)
    for name in ("src/upswing", ".git", "full", "config"):
        Path(name).mkdir(parents=True)
    Path("ours").mkdir()
    Path("ours/study.json").touch()
    Path("file").touch()
    Path("full/thesis.doc").touch()
    Path("loop").symlink_to("loop")
    Path("nowhere").symlink_to("gone")
    config = tmp_path / "config/mine.yaml"
    config.write_text(yaml.safe_dump({**SMALL, "results": folder}), "utf-8")
    with pytest.raises(BadInput) as caught:
        checked(config, Path("none"), Path("none"))
    (said,) = caught.value.problems
    assert said.startswith(f"{config}: results: ")
    assert "\n" not in said


def test_a_folder_that_is_new_empty_or_a_studys_own_is_accepted(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("empty", "own", "begun/runs", "results/smoke"):
        Path(name).mkdir(parents=True)
    Path("own/study.json").touch()
    Path("own/thesis.doc").touch()  # that was there when the study began, or came later
    Path("results/README.md").touch()
    Path("results/smoke/study.json").touch()
    for folder in ("new", "new/deep", "empty", "own", "begun", "results", str(tmp_path / "away")):
        check_results(folder, "mine.yaml")


def with_alphas(*alphas):
    experiment = {**SMALL["experiments"][0], "alphas": list(alphas)}
    return validated({"mine.yaml": {**SMALL, "experiments": [experiment]}})


@pytest.mark.parametrize(
    ("alphas", "expected"),
    [
        ([1e-320], "at least 1e-09"),
        ([0.1, 0.10000000000000002], "at most 12 digits; write 0.1"),
        ([0.5, 0.5], "0.5 stands there twice"),
    ],
)
def test_an_alpha_that_no_path_can_tell_is_refused(alphas, expected):
    with pytest.raises(BadInput, match=re.escape(expected)):
        with_alphas(*alphas)
    assert len(alpha_text(1.23456789012e-9)) < 30


def test_as_many_runs_as_are_allowed_are_checked_in_time(tmp_path):
    many = {**SMALL, "seeds": MOST_RUNS, "experiments": [{"tasks": ["balancing"], "architectures": ["idle"]}]}  # fmt: skip
    study = validated({"mine.yaml": many})
    assert len(list(Matrix(study).runs)) == MOST_RUNS == 10_000
    path = tmp_path / "mine.yaml"
    path.write_text(yaml.safe_dump({**many, "seeds": list(range(MOST_RUNS))}), "utf-8")
    for content in (many, {**many, "seeds": list(range(10 * MOST_RUNS))}):
        begin = time.process_time()
        try:
            validated({"mine.yaml": content})
        except BadInput as error:
            assert len(content["seeds"]) > MOST_RUNS
            assert "a study has at most" in str(error)  # noqa: PT017
        # 2 s are asked of the whole; what was quadratic took minutes.
        assert time.process_time() - begin < 10
    with pytest.raises(BadInput, match="at most 10,000"):
        validated({"mine.yaml": {**many, "seeds": MOST_RUNS + 1}})
    with pytest.raises(BadInput, match="come to 20,000 runs; a study has at most 10,000"):
        validated({"mine.yaml": {**many, "experiments": [{"tasks": ["balancing"], "architectures": ["idle", "random"]}]}})  # fmt: skip


@pytest.mark.heavy
@pytest.mark.parametrize("size", [15, 1_000])
def test_as_many_runs_as_are_allowed_are_planned_within_a_minute(tmp_path, size):
    """The worst case: all of them in one cell. What was quadratic took more than two minutes."""
    study = Study(tmp_path)
    experiments = [{"tasks": ["balancing"], "architectures": ["idle"]}]
    study.write({**SMALL, "seeds": MOST_RUNS, "seeds_per_job": size, "experiments": experiments})
    begin = time.monotonic()
    done = study.snakemake("--dry-run", "--quiet", "all")
    assert done.returncode == 0, done.stdout + done.stderr
    assert time.monotonic() - begin < 60


def test_of_every_job_the_first_missing_file_is_wanted(tmp_path):
    matrix = Matrix(validated({"small": {**SMALL, "seeds": 4}}))
    asked = list(matrix.wanted(tmp_path))
    assert len(asked) == len(matrix.cells) * len(matrix.blocks)
    for run in matrix.runs:
        for kind in RUN_FILES:
            (tmp_path / f"runs/{run}.{kind}").parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / f"runs/{run}.{kind}").touch()
    assert list(matrix.wanted(tmp_path)) == asked
    for run in list(matrix.runs):  # what else is missing, Snakemake's records are made to say
        path = tmp_path / f"runs/{run}.{KNOWN_FILE}"
        path.unlink()
        assert str(path) in set(matrix.wanted(tmp_path))
        path.touch()


def test_check_needs_no_module_that_computes(tmp_path):
    code = "import sys; from upswing.cli.main import main; main(['check', 'config/config.yaml']); print({'numba', 'torch', 'scipy', 'rerun'} & set(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env=dict(os.environ), capture_output=True, text=True, check=True
    )  # fmt: skip
    assert done.stdout.splitlines()[-1] == "set()"
