"""What each rule of the workflow took, from its benchmark files."""

from pathlib import Path
from typing import Any

import pandas as pd

from upswing.study.paths import JOB_COSTS

OF_A_BENCHMARK = {
    "learner": "text", "program": "text", "least": "number", "ratio": "number", "ratio_low": "number",
    "ratio_high": "number", "target": "number", "met": "truth?", "repetitions": "whole",
}  # fmt: skip
OF_GROWTH = {
    "grows": "text", "to": "whole", "seconds": "number", "cpu_seconds": "number", "megabytes": "number",
}  # fmt: skip
OF_AN_EDIT = {"edit": "text", "seconds": "number", "goal": "number", "met": "truth"}

NOT_STUDY = ("sweep", "finalists", "readings")
"""Rules of ``make readings``, which is not the study itself."""


def costs(results: Path) -> list[dict[str, Any]]:
    """One row for each kind of job: how many, their time, processor time and memory.

    Keys: ``rule``, ``jobs``, ``seconds`` (of all jobs, one after the other), ``cpu_seconds``,
    ``memory`` [MB] (of the largest job).
    """
    folder = results / JOB_COSTS
    rows = []
    for path in sorted(folder.rglob("*.tsv")):
        relative = path.relative_to(folder)
        rule = relative.parts[0].removesuffix(".tsv")
        try:
            measured = pd.read_csv(path, sep="\t", na_values="-")
        except (OSError, ValueError):
            continue  # a job that is being run has an empty one
        for _, row in measured.iterrows():
            rows.append((rule, row["s"], row.get("cpu_time"), row.get("max_rss")))
    if not rows:
        return []
    frame = pd.DataFrame(rows, columns=["rule", "seconds", "cpu_seconds", "memory"])
    grouped = frame.groupby("rule", sort=False).agg(
        jobs=("seconds", "size"),
        seconds=("seconds", "sum"),
        cpu_seconds=("cpu_seconds", "sum"),
        memory=("memory", "max"),
    )
    ordered = grouped.sort_values("seconds", ascending=False).reset_index()
    return [{str(k): v for k, v in row.items()} for row in ordered.to_dict("records")]


def totals(results: Path, learning: float) -> dict[str, float]:
    """Of all jobs: ``cpu_seconds``, the share ``learning`` of them, and ``megabytes`` on disk by folder.

    Args:
        results: a folder of results.
        learning: seconds that its runs spent learning, by their own account.
    """
    cpu = sum(float(row["cpu_seconds"]) for row in costs(results) if row["rule"] not in NOT_STUDY)
    size: dict[str, float] = {}
    for path in results.rglob("*"):
        folder = path.relative_to(results).parts[0]
        if path.is_file() and folder not in ("smoke", "readings"):
            size[folder] = size.get(folder, 0.0) + path.stat().st_size / 1e6
    return {
        "cpu_seconds": cpu,
        "learning": learning / cpu if cpu else 0.0,
        "megabytes": sum(size.values()),
    }
