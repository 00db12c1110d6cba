# What all rules know: the study that is asked for, and the files that it comes to.

import os
import re
import shutil
import sys
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger

if find_spec("upswing") is None:
    raise WorkflowError(
        f"upswing is not installed beside this snakemake ({sys.executable}): run `make install` and then "
        ".venv/bin/snakemake"
    )

from upswing.study.history_paths import ENTRIES
from upswing.study.paths import (
    BOUND,
    CHANGES,
    CHOSEN,
    MAPS,
    PREDICTION,
    PREDICTION_LIMITS,
    SETTLING,
    SHORTEST,
    TILES,
    VIEWER_PAGE,
)
from upswing.report.targets import Targets, templates
from upswing.report.targets_of_sweeps import ASKING_FOR_READINGS
from upswing.runs.as_module import check_paths, is_module, own_names
from upswing.runs.ending import GO_ON, answer_in_a_thread, say_last
from upswing.runs.needs import (
    memory,
    memory_of_training,
    minutes,
    minutes_of_training,
    needs_of_search,
)
from upswing.runs.progress import say_now_and_then
from upswing.runs.records import restore, taken_as_they_are
from upswing.runs.study_file import canonical
from upswing.study import jobs
from upswing.study.check import asked, asked_of_module
from upswing.study.claims import canonical_claims, file_of_claims
from upswing.study.config import pendulum_of_bound
from upswing.study.errors import BadInput
from upswing.study.ids import KNOWN_FILE
from upswing.study.matrix import canonical_search
from upswing.study.project_files import files_of_module, files_of_workflow

# The program beside this snakemake, whether or not its folder is on the path. (A prefix for every command would
# be one for the commands of a workflow, too, that has these rules as a module.)
BESIDE = Path(sys.executable).with_name("upswing")
UPSWING = str(BESIDE if BESIDE.exists() else shutil.which("upswing") or BESIDE)

PROJECT = Path(str(workflow.current_basedir)).parents[1]
IN_MODULE = is_module(workflow)
OWN_NAMES = own_names(workflow, ASKING_FOR_READINGS)

if not IN_MODULE:
    os.environ["PYTHONUTF8"] = "1"
    answer_in_a_thread()
    say_now_and_then(workflow)

    READ = files_of_workflow(PROJECT)
    if not workflow.configfiles:

        configfile: str(READ.config)

    report: "../report/study.rst"

    onerror:
        say_last(GO_ON)


try:
    if IN_MODULE:
        check_paths(workflow)
        READ, given = files_of_module(PROJECT, config)
        STUDY, CLAIMS, SWEEPS = asked_of_module(given, READ)
    else:
        STUDY, CLAIMS, SWEEPS = asked(
            workflow.configfiles, config, READ.claims, READ.sweeps
        )
    FILES = Targets(STUDY, CLAIMS, SWEEPS, READ.templates)
    FILES.figures  # a study may name one that it cannot draw
except BadInput as error:
    raise WorkflowError(str(error)) from None

RESULTS = STUDY.results
CLAIMS_FILE = str(file_of_claims(STUDY, otherwise=READ.claims))
SWEEPS_FILE, TEMPLATES = map(str, READ[1:3])
MATRIX = FILES.matrix
# Params get these from functions: in a text of its own Snakemake would take `{seed}` for a wildcard.
STUDY_TEXT = canonical(STUDY)
CLAIMS_TEXT = canonical_claims(CLAIMS)
SEARCH_TEXT = canonical_search(STUDY)


def told(text):
    # What a command is told and is no reason to run it again: of params, Snakemake does not compare those that
    # are functions of the output. (The names of this file are none to a workflow that has it as a module.)
    return lambda wildcards, output: text


TOLD = {
    "upswing": told(UPSWING),
    "results": told(RESULTS),
    "asked": told(STUDY_TEXT),
    "claims_file": told(CLAIMS_FILE),
    "sweeps_file": told(SWEEPS_FILE),
    "templates": told(TEMPLATES),
}


wildcard_constraints:
    figure="(?!readings-)[a-z0-9-]+",
    comparison="(task|claim)-[A-Za-z0-9-]+",
    number="[0-9]+",


@cache
def mend_records():
    # Where Snakemake has no record of how a file was made, it would take it as it is without a word.
    if workflow.is_main_process:
        unknown = restore(RESULTS, MATRIX, quick=FILES.quick, slow=FILES.slow)
        if unknown:
            logger.warning(taken_as_they_are(RESULTS, unknown))


def no_file(wildcards):
    # The input of rules that read no file but are told everything. Snakemake calls such functions for all
    # jobs of a plan after it has parsed the rules and before it looks at its records; and every plan has a job
    # that reads no file. So this is where the records are mended.
    mend_records()
    return []


def targets():
    # What this run is asked for, rules by their names here.
    return [OWN_NAMES.get(target, target) for target in workflow.dag_settings.targets]
