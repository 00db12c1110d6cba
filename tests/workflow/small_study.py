"""A small study, and a checkout of the workflow in a folder of its own to run it in."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path
from typing import Self

import yaml

from tests.paths import ROOT
from tests.workflow.warm import BIN, snakemake

KEPT = ("Snakefile", "workflow", "report", "config")
SMALL = {
    "results": "results",
    "seeds": 2,
    "seeds_per_job": 2,
    "tasks": {
        "balancing": {"kind": "balancing", "steps": 6_000},
        "full-control": {"kind": "full-control", "steps": 6_000},
    },
    "architectures": {
        "table": {"learner": "table"},
        "networks-5": {"learner": "networks", "hidden": [5]},
        "idle": {"learner": "control", "behaviour": "idle"},
        "random": {"learner": "control", "behaviour": "random"},
    },
    "experiments": [
        {"tasks": ["balancing"], "architectures": ["table", "networks-5"], "alphas": [1]},
        {"tasks": ["full-control"], "architectures": ["table"], "alphas": [0.001]},
        {"tasks": ["full-control"], "architectures": ["idle", "random"]},
    ],
}
TARGETS = ("all", "with_readings")
FIGURES_OF_SMALL = 6  # 5, 7 and 8 have all their cells, and there are three of ours

BEING_WRITTEN = shutil.ignore_patterns("*.pyc.*")
"""Python's own files that another process is about to rename."""


def surroundings() -> dict[str, str]:
    """The environment of a study: our programs first, and sources are compiled once, not by every job."""
    kept = {key: text for key, text in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    return {**kept, "PATH": f"{BIN}:{os.environ['PATH']}"}


class Study:
    """A checkout's workflow in a temporary folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for name in KEPT:
            source = ROOT / name
            copy = shutil.copytree if source.is_dir() else shutil.copy
            copy(source, folder / name)
        self.write(SMALL)

    def write(self, content) -> None:
        text = content if isinstance(content, str) else yaml.safe_dump(content)
        (self.folder / "config/small.yaml").write_text(text, "utf-8")

    def snakemake(self, *arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
        """Snakemake on the study, on two cores."""
        words = ["--cores", "2", "--profile", "workflow/profiles/default"]
        words += ["--configfile", "config/small.yaml", "--printshellcmds"]
        words += arguments
        return snakemake(words, self.folder, self.surroundings(**more))

    def surroundings(self) -> dict[str, str]:
        return surroundings()

    def copied(self, folder: Path) -> Self:
        """A copy of the study as it is, to change."""
        copy = object.__new__(type(self))
        copy.folder = Path(shutil.copytree(self.folder, folder, ignore=BEING_WRITTEN))
        return copy

    def jobs(self, *arguments: str) -> dict[str, int]:
        """Run the study and count the jobs that ran, by rule."""
        done = self.snakemake(*arguments)
        output = done.stdout + done.stderr
        assert done.returncode == 0, output
        ran: dict[str, int] = {}
        for rule in re.findall(r"^(?:local)?rule (\w+):", output, re.MULTILINE):
            ran[rule] = ran.get(rule, 0) + 1
        return {rule: count for rule, count in ran.items() if rule not in TARGETS}


RAN = "ran.json"


def run_once(folder: Path) -> None:
    """Run the small study in a folder, and note what ran."""
    ran = Study(folder).jobs()
    (folder / RAN).write_text(json.dumps(ran), "utf-8")


def as_run(once: Path, folder: Path, kind: type[Study] = Study) -> Study:
    """The small study in a folder of its own, as it was run ``once``."""
    study = kind(folder)
    for name in ("results", ".snakemake"):
        shutil.copytree(once / name, folder / name)
    return study


class Edited(Study):
    """A study with a copy of the package, which it runs and a test may edit."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        # With what Python has compiled of it, which holds as long as a file's time is the same.
        shutil.copytree(ROOT / "src", folder / "src", ignore=BEING_WRITTEN)
        self.write({**SMALL, "seeds": 2})

    def surroundings(self, versions="") -> dict[str, str]:
        return {**surroundings(), "PYTHONPATH": f"{versions}{self.folder / 'src'}"}

    def plan(self, **more):
        """The jobs that would run, by rule, without running them."""
        done = self.snakemake("--dry-run", **more)
        output = done.stdout + done.stderr
        assert done.returncode == 0, output
        planned = {}
        for rule in re.findall(r"^(?:local)?rule (\w+):", output, re.MULTILINE):
            planned[rule] = planned.get(rule, 0) + 1
        planned.pop("all", None)
        return planned

    def edit(self, file, old, new):
        path = self.folder / file
        text = path.read_text("utf-8")
        assert old in text, f"{old!r} is no longer in {file}"
        path.write_text(text.replace(old, new, 1), "utf-8")
