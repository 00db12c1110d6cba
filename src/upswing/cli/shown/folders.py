"""Folders of results: what differs between two, and whether one is whole."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from upswing.cli.terminal import say

if TYPE_CHECKING:
    from upswing.analysis.compare import Comparison
    from upswing.analysis.doctor import Diagnosis

SHOWN = 10
"""Largest number of runs that are named of a long list."""

INDENT = 4
"""Of what belongs to the line above [columns]."""


def print_comparison(comparison: "Comparison") -> None:
    """Print what differs between two folders."""
    for claim, before, after in comparison.changed_verdicts:
        say(f"{claim}: {before} → {after}", INDENT)
    if not comparison.changed_verdicts:
        say("every verdict is the same")
    for claim, what, one, other in comparison.parted_estimates:
        say(
            f"{claim}: {what}: {one:.4g} → {other:.4g}, outside each other's intervals",
            INDENT,
        )
    changed = len(comparison.changed_runs)
    say(f"{changed} of {comparison.common_runs} runs that both have are not identical")
    _name(comparison.changed_runs)
    for side, runs in (("first", comparison.only_in_a), ("second", comparison.only_in_b)):
        if runs:
            say(f"{len(runs)} runs are only in the {side}")
            _name(runs)


def _name(runs: Sequence[str]) -> None:
    for run in runs[:SHOWN]:
        print(f"  {run}")
    if len(runs) > SHOWN:
        print(f"  … and {len(runs) - SHOWN} more")


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
