"""Is a folder of results whole? Every file is read, its checksum compared, every row traced to a run."""

from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from upswing.fingerprint import COMPUTING_PACKAGES
from upswing.matrix import RUN_FILES, Matrix
from upswing.problems import BadInput
from upswing.spec import Spec
from upswing.store.checksums import checksum
from upswing.store.trajectory import read_metadata
from upswing.study import read_study
from upswing.tables import CELLS, EVIDENCE, RUNS, VERDICTS


class Finding(NamedTuple):
    """Something that is not as it should be."""

    path: Path
    what: str
    remedy: str  # what to do: a command, or words


class Diagnosis(NamedTuple):
    """What was looked at, and what was found."""

    runs: int
    files: int
    findings: list[Finding]
    orphans: list[Path]  # files below runs/ that no run of the study has
    notes: list[str]  # what is no fault


def examine(results: Path) -> Diagnosis:
    """Look at everything in a folder of results.

    Raises:
        BadInput: the folder has no readable ``study.json``, so nobody can say what should be in it.
    """
    matrix = Matrix(read_study(results))
    findings: list[Finding] = []
    found: dict[str, dict[str, Any]] = {}
    for spec in matrix.cells.values():
        for seed in spec.seeds:
            metadata = None
            for finding in _of_run(results, spec, seed):
                if isinstance(finding, Finding):
                    findings.append(finding)
                else:
                    metadata = finding
            if metadata is not None:
                found[spec.run(seed)] = metadata
    findings += _of_tables(results, found)
    runs = sum(len(spec.seeds) for spec in matrix.cells.values())
    return Diagnosis(
        runs, len(RUN_FILES) * runs, findings, orphans(results, matrix), _versions(found)
    )


def orphans(results: Path, matrix: Matrix) -> list[Path]:
    """The files of runs that are not, or no longer, in the study; and what an accident left behind."""
    expected = {results / "runs" / f"{run}.{kind}" for run in matrix.runs for kind in RUN_FILES}
    there = (path for path in (results / "runs").rglob("*") if path.is_file())
    return sorted(path for path in there if path not in expected)


def _of_run(results: Path, spec: Spec, seed: int) -> Iterator[Finding | dict[str, Any]]:
    """What is wrong with a run's files; and the metadata of its windows, if they can be read."""
    place = results / "runs" / spec.run(seed)
    windows = place.with_name(f"{place.name}.windows.parquet")
    paths = {kind: place.with_name(f"{place.name}.{kind}") for kind in RUN_FILES}
    for path in paths.values():
        if not path.is_file():
            yield Finding(path, "missing", "run the study again")
    if not windows.is_file():
        return
    try:
        pq.read_table(windows)
        metadata = read_metadata(windows)
    except (OSError, pa.ArrowException, KeyError, TypeError, ValueError) as error:
        yield _damaged(windows, f"cannot be read: {str(error).splitlines()[0]}")
        return
    if metadata.get("spec") != spec.of_seed(seed).canonical():
        yield _damaged(windows, f"is of another specification: {metadata.get('spec')}")
    for kind, recorded in metadata.get("checksums", {}).items():
        path = paths[kind]
        if path.is_file() and checksum(path) != recorded:
            yield _damaged(path, "is not the file that was written: its checksum differs")
    yield metadata


def _damaged(path: Path, what: str) -> Finding:
    return Finding(path, what, f"rm '{path}'  # and run the study again")


def _of_tables(results: Path, found: dict[str, dict[str, Any]]) -> Iterator[Finding]:
    """Whether every row of the table of runs is that of a run, and the other tables can be read."""
    for table in (RUNS, CELLS, VERDICTS, EVIDENCE):
        path = results / table
        if not path.is_file():
            yield Finding(path, "missing", "run the study again")
            continue
        try:
            frame = pd.read_parquet(path)
        except (OSError, pa.ArrowException, ValueError) as error:
            yield _damaged(path, f"cannot be read: {str(error).splitlines()[0]}")
            continue
        if table == RUNS:
            for row in frame.to_dict("records"):
                metadata = found.get(str(row["run"]))
                if metadata is None:
                    yield _damaged(
                        path, f"{row['run']}: there is no such run, or it cannot be read"
                    )
                elif metadata["outcome"]["digest"] != row["digest"]:
                    yield _damaged(path, f"{row['run']}: the row is not of the run that is there")
            for run in found.keys() - set(frame["run"]):
                yield _damaged(path, f"{run}: has no row")


def _versions(found: dict[str, dict[str, Any]]) -> list[str]:
    """Where runs were made with other versions of what computes than those installed here."""
    installed = {name: version(name) for name in COMPUTING_PACKAGES}
    other: dict[str, int] = {}
    for metadata in found.values():
        for name, made_with in metadata["provenance"]["packages"].items():
            if name in installed and made_with != installed[name]:
                words = f"{name} {made_with}, here is {installed[name]}"
                other[words] = other.get(words, 0) + 1
    return [f"{count} runs were made with {words}" for words, count in sorted(other.items())]


def delete_orphans(results: Path) -> list[Path]:
    """Delete the files of runs that are not in the study, and folders left empty; returns the files."""
    if not (results / "study.json").is_file():
        raise BadInput([f"{results}/study.json: missing; it says which runs belong to the study"])
    gone = orphans(results, Matrix(read_study(results)))
    for path in gone:
        path.unlink()
    for folder in sorted((results / "runs").rglob("*"), reverse=True):
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
    return gone
