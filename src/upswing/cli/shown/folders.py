"""Whether a folder of results is whole."""

import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from upswing.cli.terminal import say

if TYPE_CHECKING:
    from upswing.analysis.doctor import Diagnosis

INDENT = 4
"""Of what belongs to the line above [columns]."""


def print_diagnosis(diagnosis: "Diagnosis", results: Path) -> None:
    """Print what is wrong with a folder of results and what to do, or that nothing is."""
    for finding in diagnosis.findings:
        say(f"{finding.path}: {finding.what}", INDENT)
        print(f"{'':{INDENT}}{finding.remedy}")  # a command, to be copied as it stands
    if diagnosis.orphans:
        first = diagnosis.orphans[0]
        say(f"{len(diagnosis.orphans)} files are of no run of the study, {first} first;", INDENT)
        print(f"{'':{INDENT}}{_cleaning(results)}  # lists them, and deletes them with --yes")
    for note in diagnosis.notes:
        say(note, INDENT)
    state = f"{len(diagnosis.findings)} findings" if diagnosis.findings else "all whole"
    say(f"{diagnosis.runs} runs, {diagnosis.files} files: {state}")


def print_orphans(orphans: Sequence[Path], results: Path, deleted: bool) -> None:
    """Print the files of no run of the study, a line each, and how to delete them or that they are."""
    for path in orphans:
        print(path)
    if not orphans:
        say(f"{results}: every file is of a run of the study")
    elif deleted:
        say(f"deleted {len(orphans)} files")
    else:
        say(f"{len(orphans)} files are of no run of the study; nothing is deleted without --yes:")
        print(f"{'':{INDENT}}{_cleaning(results)} --yes")


def _cleaning(results: Path) -> str:
    """The command that lists what is of no run, to be copied as it stands."""
    return f"upswing clean-orphans {shlex.quote(str(results))}"
