"""What the page shows of the history: the entries, and how each verdict went over them."""

from pathlib import Path
from typing import Any, NamedTuple

from upswing.analysis.history.entry import Changed, Listed
from upswing.analysis.history.read import listed
from upswing.study.claim_parts import NOT_HERE, words_of

MOST = 10
"""Largest number of entries that the page shows, the newest."""

MOST_KEYS = 6
"""Largest number of changed keys that are named of an entry."""

SIGNS = {"reproduced": "✓", "partly": "◐", "not reproduced": "✗", "inconclusive": "?"}


class ShownEntry(NamedTuple):
    """An entry as the page shows it."""

    number: int
    id: str
    when: str
    commit: str
    runs: int
    cells: int
    notes: list[str]
    first: bool
    changed: tuple[Changed, ...]  # keys of the configuration
    more_keys: int
    verdicts: tuple[Changed, ...]
    counts: list[str]


def history(results: Path, *, judges: bool = True, own: bool = False) -> dict[str, Any]:
    """The newest entries, the newest first; how many are older; of each claim a verdict for each entry.

    Args:
        results: the folder of results.
        judges: whether its page has verdicts; without, no claim is in it.
        own: whether the claims are the study's own and not the thesis's.

    Raises:
        BadInput: the list of entries is not what was written.
    """
    every = listed(results)[::-1]
    shown = every[:MOST]
    judged = dict.fromkeys(
        claim for entry in shown for claim, word in entry.verdicts.items() if word != NOT_HERE
    )
    return {
        "entries": [_shown(entry, own) for entry in shown],
        "older": len(every) - len(shown),
        "judges": judges,
        "claims": [
            (claim, [_verdict(entry, claim, own) for entry in shown]) for claim in judged if judges
        ],
    }


def _verdict(entry: Listed, claim: str, own: bool) -> tuple[str, str, str]:
    """The verdict of an entry, its sign, and how it is said; all empty where it was not judged."""
    word = entry.verdicts.get(claim, NOT_HERE)
    return ("", "", "") if word == NOT_HERE else (word, SIGNS.get(word, "?"), _said(word, own))


def _said(verdict: str, own: bool) -> str:
    """A stored verdict as it is shown."""
    return words_of(verdict, False, own)


def _shown(entry: Listed, own: bool) -> ShownEntry:
    runs = entry.runs
    numbers = (
        (runs.new, "new runs"),
        (runs.changed, "runs with other steps"),
        (runs.gone, "runs gone"),
        (entry.changed_cells, "cells not the same"),
    )
    return ShownEntry(
        number=entry.number,
        id=entry.id,
        when=entry.when_shown,
        commit=entry.commit_shown,
        runs=runs.all,
        cells=entry.cells,
        notes=entry.every_note,
        first=entry.before is None,
        changed=entry.configuration[:MOST_KEYS],
        more_keys=max(len(entry.configuration) - MOST_KEYS, 0),
        verdicts=tuple(
            Changed(what=row.what, before=_said(row.before, own), after=_said(row.after, own))
            for row in entry.changed_verdicts
        ),
        counts=[f"{number:,} {words}" for number, words in numbers if number],
    )
