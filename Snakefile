# The study from configuration to report. Each rule calls one verb of the command `upswing`.

from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger

from upswing.beyond.names import CHANGES as CHANGED, CHOSEN, FOLDER, SHORTEST
from upswing.bound.names import BOUND, MAPS
from upswing.claims import canonical_claims, load_claims
from upswing.config import from_snakemake
from upswing.figures import FIGURES, drawable, module_of
from upswing.fingerprint import COMPUTING_PACKAGES, fingerprint
from upswing.matrix import (
    RUN_FILES,
    Matrix,
    canonical_search,
    search_code,
    training_code,
)
from upswing.problems import BadInput
from upswing.recordings.names import comparison_names
from upswing.records import restore
from upswing.study import canonical
from upswing.sweeps.plan import content_of, groups, load_sweeps, sweep_code

if not workflow.configfiles:

    configfile: "config/config.yaml"


try:
    STUDY = from_snakemake(workflow.configfiles, config)
    CLAIMS = load_claims(Path("config/claims.yaml"))
    SWEEPS = load_sweeps(Path("config/readings.yaml"), STUDY)
except BadInput as error:
    raise WorkflowError(str(error)) from None

RESULTS = STUDY.results
MATRIX = Matrix(STUDY)
# Experiments with a title are changes to the thesis, held against what is possible at all.
CHANGES = any(experiment.title for experiment in STUDY.experiments)
# A figure can be drawn when all cells that it shows are in the study.
DRAWABLE = drawable(MATRIX.cells, CHANGES)


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
        expand(f"{RESULTS}/runs/{{run}}.{{kind}}", run=MATRIX.runs, kind=RUN_FILES),


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
