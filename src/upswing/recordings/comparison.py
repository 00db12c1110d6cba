"""Recordings that compare runs: all of a task, and the worst, median and best run of a claim."""

from collections.abc import Mapping
from pathlib import Path

import rerun as rr

from upswing.analysis.colours import shown_as
from upswing.recordings.claim_recording import write_claim
from upswing.recordings.comparison_names import comparison_names
from upswing.recordings.task_recording import write_task
from upswing.runs.files.ledger import seal
from upswing.runs.results import Results
from upswing.study.claims import Claim
from upswing.study.errors import BadInput, near
from upswing.study.paths import RECORDINGS, comparison


def write_comparisons(results: Results, claims: Mapping[str, Claim]) -> list[Path]:
    """Write all recordings that compare runs; returns their paths."""
    names = comparison_names(claims, results.cells)
    return [write_comparison(results, claims, name) for name in names]


def write_comparison(results: Results, claims: Mapping[str, Claim], name: str) -> Path:
    """Write one of them, ``task-…`` or ``claim-…``; returns its path.

    Raises:
        BadInput: there is no such comparison.
    """
    if name not in (known := comparison_names(claims, results.cells)):
        raise BadInput([f"comparison: {name}: no such comparison; {near(name, known)}"])
    rr.set_strict_mode(True)  # otherwise errors become warnings and data is dropped
    path = results.folder / comparison(name)
    what, _, of = name.partition("-")
    with shown_as(results.study, results.architectures):
        if what == "task":
            write_task(path, results, of)
        else:
            write_claim(path, results, of, claims[of])
    seal(results.folder, f"{RECORDINGS}/{name}", [path])
    return path
