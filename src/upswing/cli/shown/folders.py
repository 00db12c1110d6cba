"""Whether a folder of results is whole."""

from typing import TYPE_CHECKING

from upswing.cli.terminal import say

if TYPE_CHECKING:
    from upswing.analysis.doctor import Diagnosis

INDENT = 4
"""Of what belongs to the line above [columns]."""


def print_diagnosis(diagnosis: "Diagnosis") -> None:
    """Print what is wrong with a folder of results and what to do, or that nothing is."""
    for finding in diagnosis.findings:
        say(f"{finding.path}: {finding.what}", INDENT)
        print(f"{'':{INDENT}}{finding.remedy}")  # a command, to be copied as it stands
    if diagnosis.orphans:
        first = diagnosis.orphans[0]
        say(f"{len(diagnosis.orphans)} files are of no run of the study, {first} first;", INDENT)
        print(f"{'':{INDENT}}`make clean-orphans` deletes them")
    for note in diagnosis.notes:
        say(note, INDENT)
    state = f"{len(diagnosis.findings)} findings" if diagnosis.findings else "all whole"
    say(f"{diagnosis.runs} runs, {diagnosis.files} files: {state}")
