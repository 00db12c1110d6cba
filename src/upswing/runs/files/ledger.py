"""Checksums of what was written, kept apart from it: ``checksums/``, a ledger for each run and each job.

A ledger is a file of its own, so that jobs that run side by side share none, and no output of the
workflow, so that it makes nothing run. It says of each file what its SHA-256 was when it was written,
and what the job was asked for. It has a checksum of itself.
"""

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from upswing.runs.files.atomic import written
from upswing.runs.files.checksums import checksum
from upswing.study.errors import BadInput
from upswing.study.paths import CHECKSUMS

RUNS = "runs"
"""The ledgers of runs are below this folder of theirs, each named as its run."""


class Ledger(NamedTuple):
    """What a job left behind."""

    files: dict[str, str]  # path below the folder of results → SHA-256
    made_from: dict[str, str]  # what it was asked for, by name


def seal(results: Path, name: str, files: Iterable[Path], **made_from: str) -> None:
    """Write the ledger ``name`` of ``files`` that were just written; of a folder, all that is in it."""
    every = [
        path
        for file in files
        for path in (sorted(file.rglob("*")) if file.is_dir() else [file])
        if path.is_file()
    ]
    sums = {path.relative_to(results).as_posix(): checksum(path) for path in every}
    ledger = Ledger(sums, made_from)
    with written(ledger_path(results, name)) as beside:
        content = {**ledger._asdict(), "seal": _seal_of(ledger)}
        beside.write_text(json.dumps(content, indent=1, sort_keys=True) + "\n", "utf-8")


def ledger_path(results: Path, name: str) -> Path:
    """Where the ledger ``name`` is."""
    return results / CHECKSUMS / f"{name}.json"


def ledger_of_run(run: str) -> str:
    """The name of a run's ledger."""
    return f"{RUNS}/{run}"


def read_ledger(path: Path) -> Ledger:
    """A ledger read back.

    Raises:
        BadInput: it is not there, or is not what was written.
    """
    try:
        content = json.loads(path.read_bytes())
        ledger = Ledger(dict(content["files"]), dict(content["made_from"]))
        whole = content["seal"] == _seal_of(ledger)
    except FileNotFoundError:
        raise BadInput([f"{path}: missing"]) from None
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        whole = False
    if not whole:
        raise BadInput([f"{path}: is damaged: it is not what was written"])
    return ledger


def ledgers(results: Path) -> dict[str, Path]:
    """The ledgers of a folder of results by name."""
    folder = results / CHECKSUMS
    paths = sorted(path for path in folder.rglob("*.json") if not path.name.startswith("."))
    return {path.relative_to(folder).with_suffix("").as_posix(): path for path in paths}


def _seal_of(ledger: Ledger) -> str:
    return hashlib.sha256(json.dumps(ledger, sort_keys=True).encode()).hexdigest()
