"""Studies by what they are called on the command line: folders of results, or entries of a history."""

from collections.abc import Sequence
from pathlib import Path

from upswing.analysis.history.read import entries, find
from upswing.analysis.history.sides import Side, of_entry, of_folder
from upswing.study.errors import BadInput
from upswing.study.history_paths import HISTORY
from upswing.study.paths import VERDICTS


def sides(called: Sequence[str], results: Path) -> list[Side]:
    """The studies that are called so, the entries being of the history of ``results``.

    Raises:
        BadInput: a folder is none of results, or no entry is called so; all of them at once.
    """
    problems: list[str] = []
    found: list[Side] = []
    for one in called:
        try:
            found.append(side(one, results))
        except BadInput as error:
            problems += error.problems
    if problems:
        raise BadInput(list(dict.fromkeys(problems)))
    return found


def side(called: str, results: Path) -> Side:
    """The study that is called so."""
    folder = Path(called)
    if not called.startswith("@") and (folder.exists() or "/" in called):
        return of_folder(folder)
    if not called.startswith("@") and not entries(results):
        missing = f"{folder / VERDICTS}: missing; there is no such folder of results, and no entry"
        raise BadInput([f"{missing} in {results / HISTORY}"])
    entry = find(results, called)
    place = f"{entry.name}, {entry.when_shown} UTC, commit {entry.commit_shown}"
    return of_entry(results, entry.id, label=called, place=place)
