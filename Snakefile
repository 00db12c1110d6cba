# The study from configuration to report. Each rule calls one subcommand of `upswing`.

import os
import shlex
import sys
from importlib.util import find_spec
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger

if find_spec("upswing") is None:
    raise WorkflowError(
        f"upswing is not installed beside this snakemake ({sys.executable}): run `make install` and then "
        ".venv/bin/snakemake"
    )

from upswing.analysis.beyond_tables import CHANGES as CHANGED, CHOSEN, FOLDER, SHORTEST
from upswing.optimal.tables import BOUND, MAPS
from upswing.study import jobs
from upswing.study.check import asked
from upswing.study.claims import canonical_claims
from upswing.figures import FIGURES, drawable
from upswing.study.ids import RUN_FILES, file_of
from upswing.study.matrix import Matrix, canonical_search
from upswing.study.errors import BadInput
from upswing.recordings.names import comparison_names
from upswing.runs.records import restore
from upswing.runs.study_file import canonical
from upswing.study.sweeps import content_of, groups

if not workflow.configfiles:

    configfile: "config/config.yaml"


# The command `upswing` beside this snakemake, whether or not its folder is on the path; text is UTF-8.
BESIDE = shlex.quote(os.path.dirname(sys.executable))
shell.prefix(f"export PATH={BESIDE}:$PATH PYTHONUTF8=1; ")

try:
    STUDY, CLAIMS, SWEEPS = asked(
        workflow.configfiles,
        config,
        claims=Path("config/claims.yaml"),
        sweeps=Path("config/readings.yaml"),
    )
except BadInput as error:
    raise WorkflowError(str(error)) from None

RESULTS = STUDY.results
MATRIX = Matrix(STUDY)
# Params get these from functions: in a text of its own Snakemake would take `{seed}` for a wildcard.
STUDY_TEXT = canonical(STUDY)
CLAIMS_TEXT = canonical_claims(CLAIMS)
SEARCH_TEXT = canonical_search(STUDY)
# Experiments with a title are changes to the thesis, held against what is possible at all.
CHANGES = any(experiment.title for experiment in STUDY.experiments)
# A figure can be drawn when all cells that it shows are in the study.
DRAWABLE = drawable(MATRIX.cells, CHANGES, STUDY.figures)


BEYOND_TABLES = [f"{RESULTS}/{table}" for table in (BOUND, MAPS, CHANGED)]
if CHANGES and STUDY.search:
    BEYOND_TABLES += [f"{RESULTS}/{table}" for table in (SHORTEST, CHOSEN)]


report: "workflow/report/study.rst"


wildcard_constraints:
    task="[a-z0-9-]+",
    architecture="[a-z0-9-]+",
    alpha="[0-9.]+|none",
    figure="[a-z0-9-]+",


rule all:
    input:
        f"{RESULTS}/report/index.html",
        f"{RESULTS}/report/viewer",
        expand(
            f"{RESULTS}/tables/{{table}}.parquet",
            table=["runs", "cells", "verdicts", "evidence"],
        ),
        expand(
            f"{RESULTS}/figures/{{figure}}.{{kind}}",
            figure=DRAWABLE,
            kind=["svg", "png", "json"],
        ),
        expand(
            f"{RESULTS}/recordings/{{name}}.rrd",
            name=comparison_names(CLAIMS, MATRIX.cells),
        ),
        BEYOND_TABLES if CHANGES else [],
        lambda wildcards: list(MATRIX.wanted(Path(RESULTS))),


include: "workflow/rules/train.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/recordings.smk"
include: "workflow/rules/readings.smk"
include: "workflow/rules/beyond.smk"
include: "workflow/rules/report.smk"


# Where Snakemake has no record of how a file was made, it would take it as it is without a word.
if workflow.is_main_process and Path(RESULTS).is_dir():
    FORGOTTEN = restore(
        RESULTS,
        MATRIX,
        cheap=[
            f"{RESULTS}/study.json",
            *rules.tables.output,
            *rules.verdicts.output,
            *rules.comparisons.output,
            *expand(
                f"{RESULTS}/figures/{{figure}}.{{kind}}",
                figure=DRAWABLE,
                kind=["svg", "png", "json"],
            ),
            *rules.viewer.output,
            *rules.report.output,
            *([f"{RESULTS}/{CHANGED}"] if CHANGES else []),
        ],
        dear=[
            *(f"{RESULTS}/readings/{swept}.parquet" for swept in SWEPT),
            *(rules.readings.output if SWEPT else []),
            *(table for table in BEYOND_TABLES if CHANGES and CHANGED not in table),
        ],
    )
    if FORGOTTEN:
        logger.warning(
            f"There is no record of how {len(FORGOTTEN)} files in {RESULTS} were made, {FORGOTTEN[0]} first: "
            "they are taken as they are, whatever the code or the configuration has become since. If unsure, "
            "delete them; they will be made again"
        )
