"""A job's fingerprint covers every module that the job really imports: all kinds of jobs are run."""

import json
import os
import shutil
import subprocess
import sys
from functools import cache

import pytest
import yaml

from tests.paths import ROOT
from upswing.figures import FIGURES
from upswing.study import jobs
from upswing.study.config import load
from upswing.study.matrix import Matrix
from upswing.study.sweeps import load_sweeps

STEPS = 300

CODE_OF_RULE = {
    "tables": jobs.TABLES,
    "verdicts": jobs.VERDICTS,
    "history": jobs.HISTORY,
    "changes": jobs.CHANGES,
    "readings": jobs.READINGS,
    "comparison": jobs.COMPARISON,
    "viewer": jobs.VIEWER,
    "report": jobs.page(FIGURES),
    "bound": jobs.bound(),
    "settling": jobs.SETTLING,
    "prediction": jobs.PREDICTION,
    "tiles": jobs.tiles(),
    "finalists": jobs.FINALISTS,
}

NAMING = ("train", "sweep", "shortest", "bound", "settling", "prediction")
"""Jobs of which the answer names modules that no ``import`` statement shows."""


def small(name, folder):
    """The configuration ``name`` with all its cells, one seed and runs that are as short as can be."""
    content = yaml.safe_load((ROOT / f"config/{name}.yaml").read_text("utf-8"))
    content["results"] = str(folder / "results")
    content["seeds"] = [5000]
    content.pop("claims", None)  # of cells with step sizes that are left out here
    for experiment in content["experiments"]:
        experiment.pop("seeds", None)
    for task in content["tasks"].values():
        task["steps"] = STEPS
    if "search" in content:  # its many α's train with the same code
        for experiment in (*content["experiments"], *content["search"]["candidates"]):
            if "alphas" in experiment:
                experiment["alphas"] = experiment["alphas"][:1]
        content["search"] |= {"seeds": [1000], "lengths": [STEPS]}
    path = folder / "config.yaml"
    path.write_text(yaml.safe_dump(content), "utf-8")
    return path


def small_readings(folder):
    """The sweeps that judge claims, with one seed and one reading that is varied."""
    content = yaml.safe_load((ROOT / "config/readings.yaml").read_text("utf-8"))
    for sweep in content.values():
        sweep |= {"seeds": 1, "how": "pairs", "vary": sweep["vary"][:1], "without": [], "every": {}}
        sweep["seeds_beside"] = 1
    # Its table needs the whole grid of four readings: here it is a sweep as any other.
    content["of-networks"] = content.pop("networks") | {"rounds": [{"readings": 1, "seeds": 2}]}
    path = folder / "readings.yaml"
    path.write_text(yaml.safe_dump(content), "utf-8")
    # The study whose cells they are: another study sweeps none of them.
    shutil.copy(ROOT / "config/config.yaml", folder / "thesis.yaml")
    return path


@pytest.fixture(scope="module", params=["config", pytest.param("beyond", marks=pytest.mark.heavy)])
def ran(request, tmp_path_factory):
    """A small study of a configuration, and what each of its jobs imported."""
    folder = tmp_path_factory.mktemp(request.param)
    config, readings = small(request.param, folder), small_readings(folder)
    done = subprocess.run(
        [sys.executable, "-m", "tests.workflow.imports_of_jobs", config, readings,
         ROOT / "config/claims.yaml", ROOT / "report"],
        cwd=ROOT, env={**os.environ, "MPLBACKEND": "agg"}, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-3_000:]
    study = load(config)
    return study, load_sweeps(readings, study), json.loads(done.stdout)


def code_of(job, study, sweeps):
    """The code that the workflow takes for that of a job."""
    rule, _, what = job.partition(" ")
    if rule == "train":
        spec = Matrix(study).cells[what]
        return jobs.training(study.architectures[spec.architecture.name], spec.task.kind)
    if rule == "sweep":
        return jobs.sweep(sweeps[what], study)
    if rule == "figure":
        return jobs.figure(what)
    if rule == "shortest":
        return jobs.search(study)
    return CODE_OF_RULE[rule]


STUDY = "upswing.study."
NO_MATTER = {
    # Which file the command line takes for one that is not there: its content is told.
    "finalists": {f"{STUDY}project_files"},
    # The command line reads the study; of it this is told the pendulum, which stands in the params.
    "bound": {"upswing.runs.study_file"},
    # By which the command line says, beside the table, of which code it is.
    "sweep": {f"{STUDY}{name}" for name in ("project_files", "jobs", "code", "own_code")},
}
"""What jobs import that changes nothing in what they write."""

OPTIONS = {f"{STUDY}deep_q", f"{STUDY}actor", f"{STUDY}controller"}
"""What options of several learners are made of: a study that is read has them in full, whoever reads it. Only
those who train compute with them."""


def missing(job, modules, code):
    """What a job imports and its code lacks; but no file that a job writes depends on the command line."""
    of_cli = ("upswing", "upswing.study", f"{STUDY}places")
    own = {name for name in modules if name not in of_cli and not name.startswith("upswing.cli")}
    rule = job.partition(" ")[0]
    return own - code.modules - NO_MATTER.get(rule, set()) - (set() if rule == "train" else OPTIONS)


def test_every_kind_of_job_was_run(ran):
    study, sweeps, imported = ran
    rules = {job.partition(" ")[0] for job in imported}
    expected = {"study", "train", "tables", "verdicts", "figure", "comparison", "viewer", "report"}
    expected |= {"history"}
    of_the_thesis = {"sweep", "readings", "finalists", "tiles"}
    beyond = {"bound", "settling", "prediction", "changes", "shortest"}
    expected |= beyond if study.search else of_the_thesis
    assert rules == expected
    assert {f"train {cell}" for cell in Matrix(study).cells} <= imported.keys()
    assert {f"sweep {name}" for name in sweeps} <= imported.keys()


def test_no_module_that_a_job_imports_is_missing_from_its_fingerprint(ran):
    study, sweeps, imported = ran
    lacking = {
        job: lost
        for job, modules in imported.items()
        if job != "study" and (lost := missing(job, modules, code_of(job, study, sweeps)))
    }
    assert lacking == {}


def test_a_module_taken_out_of_the_answer_is_noticed(ran):
    """What no ``import`` statement shows is in the answer only because it is named there."""
    study, sweeps, imported = ran
    for job, modules in imported.items():
        if job.partition(" ")[0] not in NAMING:
            continue
        code = code_of(job, study, sweeps)
        for left_out in code.entries[1:]:
            kept = tuple(entry for entry in code.entries if entry != left_out)
            others = jobs.Code(kept, ()).modules
            if left_out not in others:  # else another part imports it
                assert left_out in missing(job, modules, jobs.Code(kept, ())), (job, left_out)


@cache
def beyond():
    return load(ROOT / "config/beyond.yaml")


@pytest.mark.parametrize(
    ("architecture", "reached", "not_reached"),
    [
        ("gated-table", "agents.learners.table", "agents.learners.networks"),
        ("gated-networks-5", "agents.learners.networks", "agents.learners.table"),
        ("table", "agents.algorithms.q_learning", "agents.algorithms.sarsa"),
        ("hashed", "agents.features.fine", "agents.features.tilings"),
    ],
)
def test_an_architecture_reaches_what_it_uses_and_nothing_else(architecture, reached, not_reached):
    modules = jobs.training(beyond().architectures[architecture], "full-control").modules
    assert f"upswing.{reached}" in modules
    assert f"upswing.{not_reached}" not in modules
    assert "upswing.physics.tasks.balancing" not in modules
