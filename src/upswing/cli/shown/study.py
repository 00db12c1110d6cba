"""The cells of a study, and what its folder holds of them."""

import sys
from typing import TYPE_CHECKING

from upswing.cli.terminal import print_table, say
from upswing.study.matrix import Matrix

if TYPE_CHECKING:
    from upswing.runs.outlook import Outlook


def print_matrix(matrix: Matrix) -> None:
    """Print a row for each cell, and what all of them come to."""
    rows = [
        (name, f"{len(cell.seeds):,}", f"{cell.task.steps:,}")
        for name, cell in matrix.cells.items()
    ]
    print_table(("cell", "runs", "steps a run"), rows, right=("runs", "steps a run"))
    steps = sum(cell.task.steps * len(cell.seeds) for cell in matrix.cells.values())
    runs = _number(len(list(matrix.runs)), "run")
    say(f"{_number(len(matrix.cells), 'cell')}, {runs}, {steps:,} steps")


def _number(count: int, of: str) -> str:
    return f"{count:,} {of}{'' if count == 1 else 's'}"


def outlook_in_words(outlook: "Outlook", results: str) -> str:
    """What is in a folder of results, and about how long and how large the rest will be."""
    runs = f"{outlook.runs:,} runs"
    if not outlook.to_train:
        return f"{results}: all {runs} are there, none is to be trained; {_size(outlook)}"
    there = (
        f"{outlook.there:,} of {runs} are there"
        if outlook.there or outlook.anew
        else "none is there"
    )
    again = outlook.anew
    anew = (
        f", {again:,} of them anew, for the configuration or the code has changed" if again else ""
    )
    rates = "by what its jobs took before" if outlook.measured else "by what such jobs usually take"
    return (
        f"{results}: {there}, {outlook.to_train:,} are to be trained{anew}: about "
        f"{_duration(outlook.seconds)} on all {outlook.processors} processors of this machine, {rates}; "
        f"{_size(outlook)}"
    )


def print_outlook(outlook: "Outlook", results: str, *, beginning: bool = False) -> None:
    """Print it; at the beginning of a study beside what a program reads, which is the folder alone."""
    words = outlook_in_words(outlook, results)
    if beginning:
        print(words, file=sys.stderr)
        print(results)
    else:
        say(words)


def _size(outlook: "Outlook") -> str:
    amount = outlook.megabytes
    return (
        f"the runs take about {amount / 1000:.1f} GB"
        if amount >= 1000
        else (f"the runs take about {amount:.0f} MB")
    )


def _duration(seconds: float) -> str:
    if seconds < 90:
        return f"{max(round(seconds / 5) * 5, 5)} s"
    if seconds < 90 * 60:
        return f"{seconds / 60:.0f} minutes"
    return f"{seconds / 3600:.1f} hours"
