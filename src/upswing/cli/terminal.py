"""Tables for the terminal."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import pandas as pd
from rich.console import Console
from rich.table import Table

from upswing.study.claims import words_of

if TYPE_CHECKING:
    from upswing.analysis.compare import Comparison
    from upswing.analysis.doctor import Diagnosis

STYLES = {
    "reproduced": "green",
    "partly": "yellow",
    "inconclusive": "magenta",
    "not reproduced": "red",
    "not in this study": "dim",
}
SHOWN = 10
"""Number of runs named of a long list."""


def print_verdicts(verdicts: pd.DataFrame) -> None:
    """Print one row for each claim."""
    columns = ("", "claim", "verdict", "estimate [95 %]", "threshold", "n", "p (Holm)", "measured")
    table = Table(*columns, show_lines=True)
    for row in verdicts.to_dict("records"):
        style = STYLES[row["verdict"]]
        table.add_row(
            row["claim"],
            row["statement"],
            f"[{style}]{words_of(row['verdict'], row['could_be_better'])}[/{style}]",
            rf"{row['estimate']:.3g} \[{row['low']:.3g}, {row['high']:.3g}]",
            row["threshold"],
            str(row["n"]),
            f"{row['p_holm']:.2g}",
            f"{row['measure']}\n[dim]{row['note']}[/dim]" if row["note"] else row["measure"],
        )
    Console().print(table)


def print_comparison(comparison: "Comparison") -> None:
    """Print what differs between two folders."""
    console = Console(highlight=False)
    for claim, before, after in comparison.changed_verdicts:
        console.print(f"{claim}: {before} → {after}")
    if not comparison.changed_verdicts:
        console.print("every verdict is the same")
    for claim, what, one, other in comparison.parted_estimates:
        console.print(f"{claim}: {what}: {one:.4g} → {other:.4g}, outside each other's intervals")
    changed = len(comparison.changed_runs)
    console.print(f"{changed} of {comparison.common_runs} runs that both have are not identical")
    _name(console, comparison.changed_runs)
    for side, runs in (("first", comparison.only_in_a), ("second", comparison.only_in_b)):
        if runs:
            console.print(f"{len(runs)} runs are only in the {side}")
            _name(console, runs)


def _name(console: Console, runs: Sequence[str]) -> None:
    for run in runs[:SHOWN]:
        console.print(f"  {run}")
    if len(runs) > SHOWN:
        console.print(f"  … and {len(runs) - SHOWN} more")


def print_diagnosis(diagnosis: "Diagnosis") -> None:
    """What is wrong with a folder of results and what to do, or that nothing is."""
    for finding in diagnosis.findings:
        print(f"{finding.path}: {finding.what}\n    {finding.remedy}")
    if diagnosis.orphans:
        print(
            f"{len(diagnosis.orphans)} files are of no run of the study, {diagnosis.orphans[0]} first;"
        )
        print("    `make clean-orphans` deletes them")
    for note in diagnosis.notes:
        print(note)
    state = f"{len(diagnosis.findings)} findings" if diagnosis.findings else "all whole"
    print(f"{diagnosis.runs} runs, {diagnosis.files} files: {state}")
