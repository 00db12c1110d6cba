"""The entries of a history read back, and one found by what it is called."""

import re
from pathlib import Path

from upswing.analysis.history.entry import Entries, Entry, Head, Listed, Note, parsed
from upswing.analysis.history.working_copy import commit_of
from upswing.study.errors import BadInput, near, shown
from upswing.study.history_paths import ENTRIES, ENTRY, HISTORY, notes_of

LAST = "@last"
SHORTEST_COMMIT = 4
"""Smallest number of digits by which a commit is called, as in git."""


class Notes(Head):
    """The file of notes that were added to an entry."""

    notes: tuple[Note, ...]


def entries(results: Path) -> list[Listed]:
    """The heads of all entries below a folder of results, the oldest first; none of what is damaged."""
    return _read(results)[0]


def damaged(results: Path) -> list[str]:
    """A line for each entry that cannot be read."""
    return _read(results)[1]


def _read(results: Path) -> tuple[list[Listed], list[str]]:
    folder = results / HISTORY
    found: list[Listed] = []
    problems: list[str] = []
    for path in sorted(folder.iterdir()) if folder.is_dir() else ():
        if path.name.startswith(".") or not path.is_dir():
            continue
        try:
            entry = read_entry(results, path.name)
            found.append(Listed(**entry.model_dump(), notes=added_notes(results, path.name)))
        except BadInput as error:
            problems += error.problems
    return sorted(found, key=lambda entry: (entry.number, entry.when)), problems


def read_entry(results: Path, entry: str) -> Entry:
    """The head of an entry, by its id.

    Raises:
        BadInput: it is missing, or not what was written.
    """
    path = results / HISTORY / entry / ENTRY
    try:
        content = path.read_bytes()
    except OSError as error:
        raise BadInput([f"{path}: cannot be read: {error.strerror}"]) from None
    read = parsed(Entry, content, str(path))
    assert isinstance(read, Entry)  # noqa: S101  for the types
    return read


def added_notes(results: Path, entry: str) -> tuple[Note, ...]:
    """The notes that were added to an entry after it was written.

    Raises:
        BadInput: their file is not what was written.
    """
    path = results / notes_of(entry)
    if not path.is_file():
        return ()
    read = parsed(Notes, path.read_bytes(), str(path))
    assert isinstance(read, Notes)  # noqa: S101
    return read.notes


def listed(results: Path) -> list[Listed]:
    """The entries as their list in one file has them, the oldest first: what the page is made from.

    Raises:
        BadInput: the list is not what was written.
    """
    path = results / ENTRIES
    if not path.is_file():
        return []
    read = parsed(Entries, path.read_bytes(), str(path))
    assert isinstance(read, Entries)  # noqa: S101
    return list(read.entries)


def find(results: Path, called: str) -> Listed:
    """The entry that is called ``@1``, ``@last``, by its id or the beginning of it, or by its commit.

    Raises:
        BadInput: there is none, or several; it says which are near, or which they are.
    """
    every = entries(results)
    source = str(results / HISTORY)
    if not every:
        said = "there is no entry; a study leaves one when it has come out otherwise"
        raise BadInput([f"{source}: {called}: {said}"])
    if called.startswith("@"):
        return _numbered(every, called, source)
    matches = [entry for entry in every if called and entry.id.startswith(called)]
    if exact := [entry for entry in matches if entry.id == called]:
        return exact[0]
    if len(matches) == 1:
        return matches[0]
    if matches:
        raise BadInput([_several(source, called, "ids that begin so", matches)])
    commit = called.lower() if _is_hexadecimal(called) else commit_of(called)
    made = [entry for entry in every if commit and entry.commit.startswith(commit)]
    if len(made) == 1:
        return made[0]
    if made:
        raise BadInput([_several(source, called, "entries of that commit", made)])
    if commit:
        said = f"no entry was made at that commit; there are {_commits(every)}"
        raise BadInput([f"{source}: {called}: {said}"])
    hint = near(
        called, [LAST, *(name for entry in every for name in (entry.id, f"@{entry.number}"))]
    )
    raise BadInput([f"{source}: {shown(called)}: no entry is called so; {hint}"])


def _numbered(every: list[Listed], called: str, source: str) -> Listed:
    if called == LAST:
        return every[-1]
    found = [entry for entry in every if called == f"@{entry.number}"]
    if not found:
        first, last = every[0].number, every[-1].number
        numbers = f"there are @{first} to @{last}" if len(every) > 1 else f"there is @{first}"
        gaps = len(every) < last - first + 1
        said = f"{numbers}{', with gaps' if gaps else ''}, and @last is the newest"
        raise BadInput([f"{source}: {called}: there is no such entry; {said}"])
    return found[-1]


def _several(source: str, called: str, what: str, found: list[Listed]) -> str:
    names = ", ".join(f"@{entry.number} ({entry.id})" for entry in found)
    return f"{source}: {called}: there are {len(found)} {what}: {names}; say which by @"


def _commits(every: list[Listed]) -> str:
    return ", ".join(dict.fromkeys(f"{entry.commit[:10]}" for entry in every[::-1]))


def _is_hexadecimal(text: str) -> bool:
    return bool(re.fullmatch(f"[0-9a-fA-F]{{{SHORTEST_COMMIT},40}}", text))
