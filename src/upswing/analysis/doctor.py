"""Is a folder of results whole? Every file is read, its checksum compared, every row traced to a run."""

import shlex
from collections.abc import Iterator, Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any, NamedTuple

import pyarrow as pa
import pyarrow.parquet as pq

from upswing.analysis.recount import judged_by, recount
from upswing.runs.adopted import FOLDER as ADOPTED
from upswing.runs.adopted import Joined, joined
from upswing.runs.files.checksums import checksum
from upswing.runs.files.ledger import (
    RUNS as OF_RUNS,
)
from upswing.runs.files.ledger import Ledger, ledger_of_run, ledger_path, ledgers, read_ledger
from upswing.runs.files.trajectory import read_metadata
from upswing.study.claims import Claim, canonical_claims, file_of_claims, load_claims
from upswing.study.errors import BadInput
from upswing.study.fingerprint import COMPUTING_PACKAGES
from upswing.study.history_paths import ENTRIES, HISTORY
from upswing.study.ids import RUN_FILES, file_of
from upswing.study.paths import CELLS, CHECKSUMS, EVIDENCE, RUNS, STUDY, VERDICTS
from upswing.study.spec import Spec

NOT_OURS = ("README.md", "logs", "benchmarks", CHECKSUMS, "runs", ADOPTED, "report/snakemake.html")
"""What has no checksum: what a job said, what Snakemake measured or reports, runs and which of them were
adopted (looked at singly)."""

AGAIN = "run the study again"


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


def examine(results: Path, claims: Path | None = None) -> Diagnosis:
    """Look at everything in a folder of results.

    Args:
        results: the folder.
        claims: the file of claims; without, the study's own, or the thesis's. Where the verdicts were
            judged by these, they are judged again.

    Raises:
        BadInput: the folder has no readable ``study.json``, so nobody can say what should be in it.
    """
    matrix = joined(results)
    sealed = (results / CHECKSUMS).is_dir()
    findings: list[Finding] = []
    if not sealed:
        what = "missing: nobody can say whether the files are those that were written"
        findings.append(Finding(results / CHECKSUMS, what, "make clean  # and run the study again"))
    found: dict[str, dict[str, Any]] = {}
    for spec in matrix.cells.values():
        for seed in spec.seeds:
            for finding in _of_run(results, spec, seed, sealed):
                if isinstance(finding, Finding):
                    findings.append(finding)
                else:
                    found[spec.run(seed)] = finding
    whole = not findings
    files, others = _of_jobs(results, sealed)
    findings += others
    runs = sum(len(spec.seeds) for spec in matrix.cells.values())
    notes = [*_versions(found), *_left_out(matrix)]
    if whole:
        named = {finding.path for finding in findings}
        judged, note = _claims(results, file_of_claims(matrix.study, claims))
        notes += note
        findings += [
            _damaged(results / table, what)
            for table, what in recount(results, matrix, found, judged)
            if results / table not in named
        ]
    return Diagnosis(runs, len(RUN_FILES) * runs + files, findings, orphans(results, matrix), notes)


def orphans(results: Path, matrix: Joined) -> list[Path]:
    """The files of runs that are not, or no longer, in the study; and what an accident left behind."""
    expected = {results / file_of(run, kind) for run in _runs_to_keep(matrix) for kind in RUN_FILES}
    there = (path for path in (results / "runs").rglob("*") if path.is_file())
    return sorted(path for path in there if path not in expected)


def _runs_to_keep(matrix: Joined) -> Iterator[str]:
    """The runs of the study and of adopted agents, of those too that do not go with it now."""
    yield from matrix.runs
    for spec in matrix.left_out:
        yield from (spec.run(seed) for seed in spec.seeds)


def _left_out(matrix: Joined) -> list[str]:
    return [
        f"{spec.cell}: was adopted when the study had another task of this name, or other readings: "
        "it is in no table; adopt it again"
        for spec in matrix.left_out
    ]


def _of_run(
    results: Path, spec: Spec, seed: int, sealed: bool
) -> Iterator[Finding | dict[str, Any]]:
    """What is wrong with a run's files; and the metadata of its windows, if they can be read."""
    run = spec.run(seed)
    paths = {kind: results / file_of(run, kind) for kind in RUN_FILES}
    windows = paths["windows.parquet"]
    there = [path for path in paths.values() if path.is_file()]
    yield from (Finding(path, "missing", AGAIN) for path in paths.values() if path not in there)
    named: set[Path] = set()
    if there and sealed:
        for finding in _of_ledger(results, ledger_path(results, ledger_of_run(run)), there):
            named.add(finding.path)
            yield finding
    if windows not in there or windows in named:
        return
    try:
        pq.read_table(windows)
        metadata = read_metadata(windows)
    except (OSError, pa.ArrowException, KeyError, TypeError, ValueError) as error:
        problem = error.problems[0] if isinstance(error, BadInput) else str(error)
        yield _damaged(windows, f"cannot be read: {(problem.splitlines() or [''])[0]}")
        return
    if metadata["spec"] != spec.of_seed(seed).canonical():
        yield _damaged(windows, f"is of another specification: {metadata['spec']}")
        return
    for kind, recorded in metadata.get("checksums", {}).items():
        path = paths.get(kind)
        if path in there and path not in named and checksum(path) != recorded:
            yield _damaged(path, "is not the file that was written: its checksum differs")
    yield metadata


def _of_ledger(results: Path, path: Path, there: list[Path]) -> Iterator[Finding]:
    """What is wrong with files by their ledger; ``there`` are those that it should have."""
    files = " ".join(f"'{each}'" for each in (path, *there))
    kept = f"rm -f {files}  # and {AGAIN}"
    try:
        ledger = read_ledger(path)
    except BadInput as problem:
        missing = not path.is_file()
        what = "missing: it has the checksums of these files" if missing else "is damaged"
        yield Finding(path, what if missing else f"{what}: {problem.problems[0]}", kept)
        return
    for file, recorded in ledger.files.items():
        if (results / file).is_file() and checksum(results / file) != recorded:
            what = "is not the file that was written: its checksum differs"
            yield _damaged(results / file, what)
    for each in there:
        if each.relative_to(results).as_posix() not in ledger.files:
            yield _damaged(each, f"has no checksum in {path}")


def _of_jobs(results: Path, sealed: bool) -> tuple[int, list[Finding]]:
    """How many files there are besides those of runs, and what is wrong with them."""
    findings: list[Finding] = []
    of_file: dict[str, Ledger] = {}
    for name, path in ledgers(results).items():
        if name.startswith(f"{OF_RUNS}/"):
            continue
        try:
            ledger = read_ledger(path)
        except BadInput:
            findings.append(_damaged(path, "is damaged: it is not what was written"))
            continue
        for file, recorded in ledger.files.items():
            of_file[file] = ledger
            if not (results / file).is_file():
                words = f"{AGAIN}; if that does not make it, rm '{path}'"
                findings.append(Finding(results / file, "missing", words))
            elif checksum(results / file) != recorded:
                what = "is not the file that was written: its checksum differs"
                findings.append(_damaged(results / file, what))
    there = list(_files(results))
    if sealed:
        findings += [
            _damaged(path, f"has no checksum in {results / CHECKSUMS}")
            for path in there
            if path.relative_to(results).as_posix() not in of_file
        ]
    for table in (RUNS, CELLS, VERDICTS, EVIDENCE):
        if not (results / table).is_file() and table not in of_file:
            findings.append(Finding(results / table, "missing", AGAIN))
    return len(there), [
        finding._replace(remedy=_of_an_entry(results, finding.path) or finding.remedy)
        for finding in findings
    ]


def _files(results: Path) -> Iterator[Path]:
    """The files of a study that are not of runs; a folder with a study of its own is another's."""
    others = [path.parent for path in results.glob(f"*/{STUDY}")]
    skipped = [*(results / name for name in NOT_OURS), *others]
    for path in sorted(results.rglob("*")):
        hidden = any(part.startswith(".") for part in path.relative_to(results).parts)
        elsewhere = any(path.is_relative_to(place) for place in skipped)
        if path.is_file() and not hidden and not elsewhere:
            yield path


def _damaged(path: Path, what: str) -> Finding:
    return Finding(path, what, f"rm '{path}'  # and {AGAIN}")


def _of_an_entry(results: Path, file: Path) -> str | None:
    """What to do about a file of an entry of the history, which no job makes again; None for others."""
    place = file.relative_to(results).parts
    if place[0] == CHECKSUMS:
        place = place[1:]
    if place[0] != HISTORY or len(place) < 2 or f"{HISTORY}/{place[1]}" == ENTRIES:
        return None
    entry = place[1].removesuffix(".json")
    if entry.endswith(".notes"):
        both = (results / HISTORY / f"{entry}.json", ledger_path(results, f"{HISTORY}/{entry}"))
        return f"rm -f {shlex.join(map(str, both))}  # or put back a copy"
    command = f"upswing history delete {entry} --yes --results '{results}'"
    return f"{command}  # or put back a copy: no job makes an entry again"


def _claims(results: Path, path: Path) -> tuple[Mapping[str, Claim] | None, list[str]]:
    """The claims to judge by again; and a note where they are not those that were judged by."""
    recorded = judged_by(results)
    try:
        claims = load_claims(path)
    except BadInput:
        claims = None
    if claims is None or recorded is None or canonical_claims(claims) != recorded:
        return None, [f"the verdicts were not judged again: they are not of the claims in {path}"]
    return claims, []


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


def orphans_of(results: Path) -> list[Path]:
    """The files of runs that are not in the study that a folder is of.

    Raises:
        BadInput: nothing in the folder says which runs are.
    """
    return orphans(results, _joined(results))


def delete_orphans(results: Path) -> list[Path]:
    """Delete the files of runs that are not in the study, and folders left empty; returns the files.

    The ledgers of these runs go with them.
    """
    matrix = _joined(results)
    gone = orphans(results, matrix)
    for path in gone:
        path.unlink()
    known = {ledger_of_run(run) for run in _runs_to_keep(matrix)}
    for name, path in ledgers(results).items():
        if name.startswith(f"{OF_RUNS}/") and name not in known:
            path.unlink()
    for place in (results / "runs", results / CHECKSUMS / OF_RUNS):
        for folder in sorted(place.rglob("*"), reverse=True):
            if folder.is_dir() and not any(folder.iterdir()):
                folder.rmdir()
    return gone


def _joined(results: Path) -> Joined:
    if not (results / STUDY).is_file():
        raise BadInput([f"{results}/{STUDY}: missing; it says which runs belong to the study"])
    return joined(results)
