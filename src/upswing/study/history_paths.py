"""Where the history of a study stands, below its folder of results; and what a note to it may be.

Apart from ``paths``, which training knows: the history is none of its business.
"""

from upswing.study.errors import BadInput, shown

HISTORY = "history"

ENTRIES = f"{HISTORY}/entries.json"
"""The heads of all entries in one file: what the page reads, and what the workflow knows of them."""

LEDGER_OF_ENTRIES = HISTORY

ENTRY, STUDY, CLAIMS, PATCH = "entry.json", "study.json", "claims.json", "changes.patch"
RUNS, CELLS, VERDICTS, EVIDENCE = (
    "runs.parquet", "cells.parquet", "verdicts.parquet", "evidence.parquet",
)  # fmt: skip
"""The files of an entry."""

UNFINISHED = ".unfinished-"
"""How the folder begins in which an entry is written before it gets its place."""

NOTE = "UPSWING_NOTE"
"""The variable of the environment with the note for the next entry (``make study NOTE="…"``)."""

LONGEST_NOTE = 500
"""Of a note [characters]."""


def folder_of(entry: str) -> str:
    """The folder of an entry, by its id."""
    return f"{HISTORY}/{entry}"


def notes_of(entry: str) -> str:
    """The notes that were added to an entry after it was written: beside it, for it never changes."""
    return f"{HISTORY}/{entry}.notes.json"


def ledger_of(entry: str) -> str:
    """The name of the ledger of an entry."""
    return f"{HISTORY}/{entry}"


def ledger_of_notes(entry: str) -> str:
    """The name of the ledger of the notes to an entry."""
    return f"{HISTORY}/{entry}.notes"


def checked_note(text: str, source: str) -> str:
    """A note, without spaces around it.

    Raises:
        BadInput: it is too long, or not one line of text; ``source`` says where it is from.
    """
    note = text.strip()
    if len(note) > LONGEST_NOTE:
        right = f"has {len(note):,} characters; a note has at most {LONGEST_NOTE}"
        raise BadInput([f"{source}: {shown(note)}: {right}"])
    if not note.isprintable():
        raise BadInput([f"{source}: {shown(note)}: must be one line of text"])
    return note
