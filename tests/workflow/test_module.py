"""The rules as a module of another workflow: files are the rules' own, and nothing of it leaks out."""

import os
import subprocess

import pandas as pd
import pytest
import yaml

from tests.paths import ROOT
from tests.workflow.small_study import BIN

TINY = {
    "results": "results/upswing",
    "seeds": 1,
    "tasks": {"balancing": {"kind": "balancing", "steps": 3_000}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]}],
}
OTHER = """
configfile: "config/config.yaml"

rule all:
    input:
        "results/mine.txt",

module upswing:
    snakefile:
        {snakefile!r}
    {more}
    config:
        config["upswing"]

use rule * from upswing as upswing_*

rule mine:
    input:
        "results/upswing/tables/verdicts.parquet",
    output:
        "results/mine.txt",
    shell:
        "echo $PATH > {{output}}"
"""


class Other:
    """A workflow of something else, with a configuration, claims and templates that are not ours."""

    def __init__(self, folder):
        self.folder = folder
        for place in ("workflow", "config", "report"):
            (folder / place).mkdir()
        (folder / "config/claims.yaml").write_text("insured: 3\n", "utf-8")
        self.write(TINY)

    def write(self, study, more="", snakefile=str(ROOT / "Snakefile")):
        text = OTHER.format(snakefile=snakefile, more=more)
        (self.folder / "workflow/Snakefile").write_text(text, "utf-8")
        (self.folder / "config/config.yaml").write_text(
            yaml.safe_dump({"mine": 3, "upswing": study}), "utf-8"
        )

    def snakemake(self, *arguments):
        return subprocess.run(
            [BIN / "snakemake", "--cores", "2", *arguments], cwd=self.folder,
            env={**os.environ, "PATH": "/usr/bin:/bin"},
            capture_output=True, text=True, check=False,
        )  # fmt: skip


@pytest.fixture
def other(tmp_path):
    return Other(tmp_path)


def test_another_workflow_makes_a_study_and_goes_on_with_it(other):
    done = other.snakemake()
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    verdicts = pd.read_parquet(other.folder / "results/upswing/tables/verdicts.parquet")
    assert "C1" in set(verdicts["claim"])
    # Its own commands run as they would without the module.
    assert (other.folder / "results/mine.txt").read_text("utf-8").strip() == "/usr/bin:/bin"
    assert {path.name for path in (other.folder / "results").iterdir()} == {"mine.txt", "upswing"}
    # Its log is its own: every job is told.
    assert "rule upswing_verdicts:" in said
    again = other.snakemake("--dry-run")
    assert "Nothing to be done" in again.stdout + again.stderr


def test_all_of_a_study_is_planned_from_another_folder(other):
    done = other.snakemake("--dry-run", "upswing_with_readings")
    said = done.stdout + done.stderr
    assert done.returncode == 0, said
    assert str(ROOT / "report/viewer.html") in said
    # It knows that the sweeps are asked for, by whatever name: the verdicts wait for them.
    (verdicts,) = [
        part for part in said.split("\n[") if "rule upswing_verdicts:" in part.splitlines()[1]
    ]
    assert "results/upswing/tables/robust.parquet" in verdicts


@pytest.mark.parametrize(
    ("study", "more", "words"),
    [
        ({**TINY, "seed": 3}, "", "config of the module: seed: unknown key"),
        (
            {**TINY, "figures": [{"name": "mine", "file": "mine.py"}]},
            "",
            "unknown key: write the name alone",
        ),
        ({**TINY, "claims": "config/none.yaml"}, "", "must be a file"),
        ({**TINY, "claims": "config/claims.yaml"}, "", "config/claims.yaml: insured"),
        (TINY, 'prefix: "elsewhere"', "say `results: FOLDER` in the module's config"),
    ],
    ids=[
        "an unknown key",
        "a file of code",
        "claims that are not there",
        "claims of another kind",
        "a prefix",
    ],
)
def test_what_is_wrong_is_said_before_anything_runs(other, study, more, words):
    other.write(study, more)
    done = other.snakemake("--dry-run")
    assert done.returncode != 0
    assert words in done.stdout + done.stderr
    assert "Traceback" not in done.stdout + done.stderr


def test_the_study_of_the_thesis_is_made_from_any_folder(tmp_path):
    done = subprocess.run(
        [BIN / "snakemake", "--dry-run", "--quiet", "all", "--snakefile", ROOT / "Snakefile"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    assert [path.name for path in tmp_path.iterdir()] in ([], [".snakemake"])
