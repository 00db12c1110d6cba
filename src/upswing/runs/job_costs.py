"""What a job of the workflow took, from Snakemake's measurement of it."""

import csv
from pathlib import Path
from typing import NamedTuple

UNKNOWN = (None, "", "-", "NA")
"""What Snakemake writes where a job was too quick to be measured."""


class JobCost(NamedTuple):
    """What a job took when it ran last."""

    seconds: float
    cpu_seconds: float  # 0 where it was too quick to be measured


def job_cost(path: Path) -> JobCost | None:
    """The measurement in a file; None where there is none: a job that is being run has an empty one."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file, delimiter="\t"))
        return (
            JobCost(
                sum(_number(row["s"]) for row in rows),
                sum(_number(row.get("cpu_time")) for row in rows),
            )
            if rows
            else None
        )
    except (OSError, ValueError, KeyError, csv.Error):
        return None


def _number(text: str | None) -> float:
    return 0.0 if text in UNKNOWN else float(str(text))
