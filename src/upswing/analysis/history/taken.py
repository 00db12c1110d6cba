"""What a study took, by what Snakemake measured of its jobs."""

from collections.abc import Iterator
from pathlib import Path

from upswing.analysis.history.entry import Taken
from upswing.runs.job_costs import JobCost, job_cost
from upswing.study.matrix import Matrix
from upswing.study.paths import JOB_COSTS

TRAINING = "train"
NOT_STUDY = ("sweep", "readings", "finalists")
"""Rules of ``make readings``, which is not the study itself."""


def taken(results: Path, matrix: Matrix, since: float) -> Taken:
    """What the jobs of a study took, and what its runs took that were trained lately.

    Args:
        results: the folder of results.
        matrix: the runs of the study.
        since: the time after which training counts as lately [s since 1970].
    """
    folder = results / JOB_COSTS
    of_job = dict(measured(folder))
    lately, runs = [], 0
    for cell, spec in matrix.cells.items():
        for block in matrix.blocks_of(spec):
            path = folder / TRAINING / cell / f"{block.name}.tsv"
            if path in of_job and path.stat().st_mtime > since:
                lately.append(of_job[path])
                runs += len(block.seeds)
    return Taken(
        trained_runs=runs,
        training_seconds=sum(job.seconds for job in lately),
        training_cpu_seconds=sum(job.cpu_seconds for job in lately),
        jobs=len(of_job),
        seconds=sum(job.seconds for job in of_job.values()),
        cpu_seconds=sum(job.cpu_seconds for job in of_job.values()),
    )


def measured(folder: Path) -> Iterator[tuple[Path, JobCost]]:
    """Every job of the study itself whose measurement can be read, from the folder of measurements."""
    for path in sorted(folder.rglob("*.tsv")):
        if path.relative_to(folder).parts[0].removesuffix(".tsv") not in NOT_STUDY:
            cost = job_cost(path)
            if cost is not None:
                yield path, cost
