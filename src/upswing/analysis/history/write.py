"""Writing an entry: whole or not at all, and none where nothing came out otherwise."""

import os
import shutil
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from upswing.analysis.compare import Comparison, compare
from upswing.analysis.history.entry import Changed, Entries, Entry, Listed, Patch, Runs
from upswing.analysis.history.read import entries
from upswing.analysis.history.sides import Side, claims_of, digest, of_entry, of_folder
from upswing.analysis.history.taken import taken
from upswing.analysis.history.working_copy import patch
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import ledger_path, seal
from upswing.runs.files.provenance import metadata, provenance
from upswing.runs.files.tables import MEASURES
from upswing.runs.study_file import read_study
from upswing.study import history_paths as places
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.paths import CHECKSUMS, STUDY

if TYPE_CHECKING:
    import pandas as pd

OF_A_RUN = (
    "run", "digest", "seed", "steps", "diverged_at", "first_stable_step", "greedy_success_share",
    *MEASURES,
)  # fmt: skip
"""What an entry keeps of each run: what its cell is made from, and what tells it apart."""

READ_ONLY = 0o444


class Written(NamedTuple):
    """What came of writing."""

    entry: Listed
    new: bool  # False where the last entry says the same already


def write_entry(results: Path, note: str = "") -> Written:
    """Write an entry for the study in a folder of results, if it is not that of the last entry.

    Args:
        results: the folder, with its tables.
        note: what is to be remembered of it.

    Raises:
        BadInput: a table is missing or of another origin.
    """
    remove_unfinished(results)
    side = of_folder(results)
    of = digest(side)
    before = entries(results)
    last = before[-1] if before else None
    if last is not None and last.digest == of:
        write_list(results)
        return Written(last, new=False)
    now = datetime.now(UTC).replace(microsecond=0)
    while (results / places.folder_of(name := f"{now:%Y%m%d-%H%M%S}-{of[:6]}")).exists():
        now += timedelta(seconds=1)  # there and back again within a second
    difference, text = patch() if provenance().dirty else (b"", True)
    found = provenance()
    entry = Entry(
        id=name,
        number=last.number + 1 if last else 1,
        when=now,
        digest=of,
        note=note,
        commit=found.git_commit,
        dirty=found.dirty,
        patch=Patch(bytes=len(difference), whole=text) if difference else None,
        python=found.python,
        packages=found.packages,
        machine=found.machine,
        processors=found.processors,
        cells=0 if side.cells is None else len(side.cells),
        verdicts={
            str(claim): str(verdict)
            for claim, verdict in zip(side.verdicts["claim"], side.verdicts["verdict"], strict=True)
        },
        taken=taken(results, Matrix(read_study(results)), last.when.timestamp() if last else 0.0),
        **_against(results, last, side),
    )
    _put(results, entry, side, difference)
    write_list(results)
    return Written(Listed(**entry.model_dump()), new=True)


def _against(results: Path, last: Listed | None, side: Side) -> dict[str, object]:
    """What an entry says of how it differs from the one before."""
    try:
        earlier = of_entry(results, last.id) if last else None
    except BadInput:  # it is damaged, which is no reason to keep nothing of this study
        earlier = None
    if last is None or earlier is None:
        count = len(side.runs)
        none = {"configuration": (), "changed_verdicts": (), "changed_cells": 0, "before": None}
        return {**none, "runs": Runs(all=count, new=count, changed=0, gone=0)}
    found = compare([earlier, side])
    return {
        "before": last.id,
        "configuration": tuple(
            Changed(what=row.key, before=row.values[0], after=row.values[1])
            for row in found.configuration or ()
        ),
        "changed_verdicts": tuple(
            Changed(what=claim, before=words[0], after=words[1]) for claim, words in found.verdicts
        ),
        "changed_cells": len({row.cell for row in found.cells}) + len(found.partial_cells),
        "runs": _runs(found, len(side.runs)),
    }


def _runs(found: Comparison, count: int) -> Runs:
    return Runs(
        all=count,
        new=len(found.partial_runs.get((False, True), ())),
        changed=len(found.changed_runs),
        gone=len(found.partial_runs.get((True, False), ())),
    )


def _put(results: Path, entry: Entry, side: Side, difference: bytes) -> None:
    """Write the files of an entry into a folder of their own, and give it its place when all are there.

    Its ledger gets its place first: an entry that is there has its checksums.
    """
    beside = results / places.HISTORY / f"{places.UNFINISHED}{os.getpid()}"
    folder = beside / places.folder_of(entry.id)
    folder.mkdir(parents=True)
    shutil.copyfile(results / STUDY, folder / places.STUDY)
    if (claims := claims_of(results)) is not None:
        (folder / places.CLAIMS).write_text(claims + "\n", "utf-8")
    if difference:
        (folder / places.PATCH).write_bytes(difference)
    runs = side.runs[[name for name in OF_A_RUN if name in side.runs]]
    _write(folder / places.RUNS, runs)
    if side.cells is not None:
        _write(folder / places.CELLS, side.cells)
    _write(folder / places.VERDICTS, side.verdicts)
    _write(folder / places.EVIDENCE, side.evidence)
    (folder / places.ENTRY).write_text(entry.model_dump_json(indent=1) + "\n", "utf-8")
    for path in folder.iterdir():
        path.chmod(READ_ONLY)
    seal(beside, places.ledger_of(entry.id), [folder])
    ledger = ledger_path(results, places.ledger_of(entry.id))
    ledger.parent.mkdir(parents=True, exist_ok=True)
    ledger_path(beside, places.ledger_of(entry.id)).replace(ledger)
    folder.replace(results / places.folder_of(entry.id))
    shutil.rmtree(beside)


def _write(path: Path, frame: "pd.DataFrame") -> None:
    """A table as small as it gets: strongly compressed, without what helps only to skip rows."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pa.Table.from_pandas(frame, preserve_index=False)
    described = {**(table.schema.metadata or {}), **metadata()}
    pq.write_table(
        table.replace_schema_metadata(described), path, compression="zstd", compression_level=15,
        write_statistics=False,
    )  # fmt: skip


def write_list(results: Path) -> None:
    """Write the heads of all entries into one file, with the notes to them."""
    with written(results / places.ENTRIES) as beside:
        every = Entries(entries=tuple(entries(results)))
        beside.write_text(every.model_dump_json(indent=1) + "\n", "utf-8")
    seal(results, places.LEDGER_OF_ENTRIES, [results / places.ENTRIES])


def remove_unfinished(results: Path) -> None:
    """Remove what a job left behind that was killed while it wrote."""
    for path in (results / places.HISTORY).glob(f"{places.UNFINISHED}*"):
        shutil.rmtree(path)
    for folder in (results / places.HISTORY, results / CHECKSUMS / places.HISTORY):
        for path in folder.glob(".*.part"):
            path.unlink()
    for ledger in (results / CHECKSUMS / places.HISTORY).glob("*.json"):
        of = ledger.name.removesuffix(".json").removesuffix(".notes")
        if not (results / places.folder_of(of)).is_dir():
            ledger.unlink()
