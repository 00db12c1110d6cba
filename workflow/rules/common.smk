# What all rules know: the study that is asked for, and the files that it comes to.

import os
import re
import shlex
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
    SHORTEST,
    TILES,
    VIEWER_PAGE,
)
from upswing.report.targets import Targets, templates
from upswing.runs.ending import answer_in_a_thread
from upswing.runs.records import restore, taken_as_they_are
from upswing.runs.study_file import canonical
from upswing.study import jobs
from upswing.study.check import asked
from upswing.study.claims import canonical_claims
from upswing.study.config import pendulum_of_bound
from upswing.study.errors import BadInput
from upswing.study.ids import KNOWN_FILE
from upswing.study.matrix import canonical_search

if not workflow.configfiles:

    configfile: "config/config.yaml"


# The command `upswing` beside this snakemake, whether or not its folder is on the path; text is UTF-8.
BESIDE = shlex.quote(os.path.dirname(sys.executable))
shell.prefix(f"export PATH={BESIDE}:$PATH PYTHONUTF8=1; ")

answer_in_a_thread()

try:
    STUDY, CLAIMS, SWEEPS = asked(
        workflow.configfiles,
        config,
        sweeps=Path("config/readings.yaml"),
    )
    FILES = Targets(STUDY, CLAIMS, SWEEPS)
    FILES.figures  # a study may name one that it cannot draw
except BadInput as error:
    raise WorkflowError(str(error)) from None

RESULTS = STUDY.results
MATRIX = FILES.matrix
# Params get these from functions: in a text of its own Snakemake would take `{seed}` for a wildcard.
STUDY_TEXT = canonical(STUDY)
CLAIMS_TEXT = canonical_claims(CLAIMS)
SEARCH_TEXT = canonical_search(STUDY)


report: "../report/study.rst"


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
