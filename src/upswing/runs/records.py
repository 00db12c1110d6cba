"""What Snakemake remembers of how files were made, mended where it is missing, unreadable or of others.

Snakemake reruns a job whose params have changed, and keeps the old ones in ``.snakemake/metadata``.
Where it has none for an output it asks nothing and takes the file as it is. What a run was made from
stands with the run as well, so its record can be restored; what is soon made again is made again.
"""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from upswing.runs.files.ledger import ledger_of_run, ledger_path, read_ledger
from upswing.study.errors import BadInput
from upswing.study.ids import KNOWN_FILE, RUN_FILES, file_of
from upswing.study.matrix import Matrix
from upswing.study.paths import VIEWER_PAGE
from upswing.study.spec import Spec

UNKNOWN = "unknown"
"""The param of a file whose making is forgotten; no job asks for it, so the file is made again."""

INCOMPLETE = "incomplete"
"""The param of a file beside which another of its job is missing; it is made again likewise."""


def restore(results: str, matrix: Matrix, quick: Sequence[str], slow: Sequence[str]) -> list[str]:
    """Mend Snakemake's records of a study, before it looks at them.

    Args:
        results: the folder of results, as the rules have it.
        matrix: the runs that are asked for.
        quick: outputs of other jobs that are made again where there is no record of them.
        slow: outputs of other jobs that are left as they are.

    Returns:
        The files that are taken as they are although nobody knows what they were made from.
    """
    if not Path(results).is_dir():
        return []
    records = Records()
    if records.locked:  # another Snakemake is at work; this one will say so
        return []
    for path in quick:
        if Path(path).exists() and records.params(path) is None:
            records.write(path, "forgotten", [UNKNOWN])
    _notice_missing(results, records)
    unknown = [path for path in slow if Path(path).exists() and records.params(path) is None]
    for path in unknown:
        records.forget(path)
    for cell, spec in matrix.cells.items():
        for block in matrix.blocks_of(spec):
            job = matrix.job(cell, block)
            unknown += _restore_job(results, f"train_{block.name}", job, records)
    return unknown


def _notice_missing(results: str, records: "Records") -> None:
    """Have the viewer made again if a file is missing that it wrote besides its page."""
    page = f"{results}/{VIEWER_PAGE}"
    try:
        files = read_ledger(ledger_path(Path(results), "viewer")).files
    except BadInput:
        return
    if Path(page).exists() and not all(Path(results, file).exists() for file in files):
        records.write(page, "viewer", [INCOMPLETE])


def taken_as_they_are(results: str, unknown: Sequence[str]) -> str:
    """What to say of files of which nobody knows what they were made from; there is at least one."""
    return (
        f"There is no record of how {len(unknown)} files in {results} were made, {unknown[0]} first: "
        "they are taken as they are, whatever the code or the configuration has become since. "
        "If unsure, delete them; they will be made again"
    )


def _restore_job(results: str, rule: str, job: Spec, records: "Records") -> Iterator[str]:
    """Mend the records of a job of training; yields the files of which nothing is known."""
    asked = job.canonical()
    for seed, text in job.canonical_runs():
        run = job.run(seed)
        path = f"{results}/{file_of(run, KNOWN_FILE)}"
        if not Path(path).exists():
            continue
        if not all(Path(results, file_of(run, kind)).exists() for kind in RUN_FILES):
            records.write(path, rule, [INCOMPLETE])
            continue
        known = records.params(path)
        if known == [repr(INCOMPLETE)]:  # what was missing has come back
            known = None
        made = _made_from(Path(results), run)
        if made is not None and made[0] == text:
            made = asked, made[1]  # as the whole job is asked for
        if made is None:
            if known is None:
                records.forget(path)
                yield path
        # A run that is as asked, from whichever block of seeds, gets a record that says so. One
        # that is not keeps no record that says what is asked: that makes the job run.
        elif known is None or (
            known != sorted(map(repr, made)) and (made[0] == asked or repr(asked) in known)
        ):
            records.write(path, rule, made)


def _made_from(results: Path, run: str) -> tuple[str, str] | None:
    """Specification and code of a run by its ledger, failing that by its windows; None if unknown."""
    try:
        made = read_ledger(ledger_path(results, ledger_of_run(run))).made_from
        return made["spec"], made["code"]
    except (BadInput, KeyError):
        pass
    windows = results / file_of(run, "windows.parquet")
    if not windows.is_file():
        return None
    from upswing.runs.files.trajectory import read_metadata

    try:
        found = read_metadata(windows)
    except BadInput:
        return None
    return (found["spec"], str(found["code"])) if "code" in found else None


class Records:
    """Snakemake's records of outputs, by their paths as its rules have them."""

    def __init__(self) -> None:
        from snakemake.persistence.file import FilePersistence

        self._snakemake = FilePersistence()

    @property
    def locked(self) -> bool:
        """Whether another Snakemake is at work in this folder."""
        return any(True for _ in self._snakemake._read_locks())

    def params(self, path: str) -> list[str] | None:
        """The params that an output was made with; None where there is no record that can be used."""
        try:
            record = json.loads(self._place(path).read_bytes())
            params = record["params"]
            usable = record["record_format_version"] >= self._version and bool(record["rule"])
        except (OSError, ValueError, KeyError, TypeError, RecursionError):
            return None
        texts = isinstance(params, list) and all(isinstance(param, str) for param in params)
        return sorted(params) if texts and usable else None

    def write(self, path: str, rule: str, params: Sequence[str]) -> None:
        """Remember that an output was made with ``params``."""
        from snakemake.persistence import MetadataRecord

        written = Path(path).stat().st_mtime
        record = MetadataRecord(
            rule=rule,
            params=sorted(map(repr, params)),
            starttime=written,
            endtime=written,
            record_format_version=self._version,
            incomplete=False,
        )
        self._snakemake._write_record(path, record)

    def forget(self, path: str) -> None:
        """Delete a record that cannot be used; Snakemake stumbles over some."""
        self._place(path).unlink(missing_ok=True)

    def _place(self, path: str) -> Path:
        found: Any = self._snakemake._record_path(self._snakemake._metadata_path, path)
        return Path(found)

    @property
    def _version(self) -> int:
        from snakemake.persistence import RECORD_FORMAT_VERSION

        return int(RECORD_FORMAT_VERSION)
