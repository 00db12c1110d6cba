"""The entries of a history."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from upswing.cli.terminal import print_table, say
from upswing.study.claim_parts import NOT_HERE
from upswing.study.history_paths import PATCH, folder_of

if TYPE_CHECKING:
    from upswing.analysis.history.entry import Entry, Listed
    from upswing.analysis.history.sides import Side

INDENT = 4
"""Of what belongs to the line above [columns]."""

MOST_KEYS = 8
"""Largest number of changed keys that the list names of an entry; ``show`` names all."""

HEADER = ("no.", "when (UTC)", "commit", "cells", "runs", "verdicts", "id")


def print_entries(entries: "Sequence[Listed]", damaged: Sequence[str], results: Path) -> None:
    """Print a row for each entry, the newest first, and below it what changed."""
    newest_first = list(entries)[::-1]
    if newest_first:
        ids = {entry.id for entry in entries}
        print_table(
            HEADER,
            [_cells(entry) for entry in newest_first],
            right=("cells", "runs"),
            words=[entry.id for entry in newest_first],
            below=[
                [
                    *(f"note: {note}" for note in entry.every_note),
                    *_changes(entry, MOST_KEYS, deleted=entry.before not in ids),
                ]
                for entry in newest_first
            ],
        )
    for problem in damaged:
        say(f"{problem}; `upswing doctor {results}` says more", INDENT)
    count = "1 entry" if len(newest_first) == 1 else f"{len(newest_first)} entries"
    say(
        f"{results}: {count}{'' if newest_first or damaged else '; a study that has run leaves one'}"
    )


def _cells(entry: "Entry") -> tuple[str, ...]:
    words = list(entry.verdicts.values())
    held = sum(word == "reproduced" for word in words)
    judged = sum(word != NOT_HERE for word in words)
    return (
        f"@{entry.number}",
        entry.when_shown,
        entry.commit_shown,
        f"{entry.cells:,}",
        f"{entry.runs.all:,}",
        f"{held} of {judged} hold",
    )


def _changes(entry: "Entry", most: int | None, *, deleted: bool = False) -> list[str]:
    """What changed against the entry before, a line each."""
    if entry.before is None:
        return ["the first entry"]
    keys = [f"{row.what}: {row.before} → {row.after}" for row in entry.configuration]
    shown = keys[:most]
    if more := len(keys) - len(shown):
        shown.append(f"… and {more} keys more (`upswing history show @{entry.number}`)")
    runs = entry.runs
    counts = [
        f"{_counted(count, 'run')} {word}"
        for count, word in (
            (runs.new, "new"),
            (runs.changed, "with other steps"),
            (runs.gone, "gone"),
        )
        if count
    ]
    if entry.changed_cells:
        counts.append(f"{_counted(entry.changed_cells, 'cell')} not the same")
    if not keys:
        counts.insert(0, "the configuration is the same")
    verdicts = [f"{row.what}: {row.before} → {row.after}" for row in entry.changed_verdicts]
    against = [f"against {entry.before}, which was deleted:"] if deleted else []
    return [*against, *shown, *([", ".join(counts)] if counts else []), *verdicts]


def _counted(count: int, what: str) -> str:
    return f"{count:,} {what}{'' if count == 1 else 's'}"


def print_entry(entry: "Listed", side: "Side", results: Path) -> None:
    """Print all that an entry holds."""
    from upswing.cli.shown.verdicts import COLOURS

    say(f"{entry.name}, {entry.when_shown} UTC")
    dirty = "; tracked files differed from it" if entry.dirty else ""
    if entry.patch is not None:
        whole = "" if entry.patch.whole else ", the beginning of the difference"
        dirty += f" ({results / folder_of(entry.id) / PATCH}, {entry.patch.bytes:,} bytes{whole})"
    facts = {
        "commit": f"{entry.commit}{dirty}",
        "study": f"{entry.cells:,} cells, {entry.runs.all:,} runs",
        "machine": f"{entry.machine}, {entry.processors} processors, Python {entry.python}",
        "versions": ", ".join(f"{name} {version}" for name, version in entry.packages.items()),
        "trained": f"{entry.taken.trained_runs:,} runs since the entry before, in "
        f"{entry.taken.training_cpu_seconds:,.0f} s of processor time",
        "took": f"{entry.taken.jobs:,} jobs, as they ran last: {entry.taken.cpu_seconds:,.0f} s of "
        f"processor time, {entry.taken.seconds:,.0f} s one after the other",
    }
    for name, text in facts.items():
        say(f"{name}: {text}", INDENT)
    for note in entry.every_note:
        say(f"note: {note}", INDENT)
    say("what changed against the entry before:" if entry.before else "what changed:")
    for line in _changes(entry, None):
        say(f"{'':{INDENT}}{line}", 2 * INDENT)
    rows = [
        {str(name): value for name, value in row.items()}
        for row in side.verdicts.to_dict("records")
    ]
    print_table(
        ("claim", "verdict", "estimate [95 %]", "runs", "what is claimed"),
        [(row["claim"], row["verdict"], _interval(row), str(row.get("n", ""))) for row in rows],
        right=("runs",),
        words=[str(row.get("statement", "")) for row in rows],
        colours=COLOURS,
    )


def _interval(row: dict[str, float]) -> str:
    if not row.get("n"):
        return "no runs"
    return f"{row['estimate']:.3g} [{row['low']:.3g}, {row['high']:.3g}]"


def print_noted(last: "Listed | None", note: str, results: Path) -> None:
    """Print whether the last entry has the note that was given to a study."""
    if last is not None and note in last.every_note:
        say(f"The note is kept with {last.name} of the history")
        return
    option = "" if str(results) == "results" else f" --results {results}"
    say(
        "Nothing changed, so no entry of the history was written, and the note is not kept; "
        f'`.venv/bin/upswing history note @last "…"{option}` adds it to the last entry'
    )
