"""What one may do to a history by hand: add a note to an entry, or delete one."""

import shutil
from datetime import UTC, datetime
from pathlib import Path

from upswing.analysis.history.entry import Note
from upswing.analysis.history.read import Notes, added_notes
from upswing.analysis.history.write import write_list
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import ledger_path, seal
from upswing.study.history_paths import (
    UNFINISHED,
    folder_of,
    ledger_of,
    ledger_of_notes,
    notes_of,
)


def add_note(results: Path, entry: str, text: str) -> None:
    """Add a note to an entry, by its id; the entry itself stays as it is."""
    now = datetime.now(UTC).replace(microsecond=0)
    every = (*added_notes(results, entry), Note(when=now, text=text))
    path = results / notes_of(entry)
    with written(path) as beside:
        beside.write_text(Notes(notes=every).model_dump_json(indent=1) + "\n", "utf-8")
    seal(results, ledger_of_notes(entry), [path])
    write_list(results)


def delete(results: Path, entry: str) -> None:
    """Delete an entry, by its id, with its notes; the others keep their numbers."""
    folder = results / folder_of(entry)
    # First out of the way, at once: what is left of it, if this is killed, is removed by the next job.
    gone = folder.with_name(f"{UNFINISHED}{entry}")
    folder.replace(gone)
    shutil.rmtree(gone)
    (results / notes_of(entry)).unlink(missing_ok=True)
    for name in (ledger_of(entry), ledger_of_notes(entry)):
        ledger_path(results, name).unlink(missing_ok=True)
    write_list(results)
