"""Which studies and which of their runs are browsed: all of a folder together, identical cells once."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from upswing.recordings.identical import once, runs_of
from upswing.recordings.run_filter import select
from upswing.runs.results import Results
from upswing.study.errors import BadInput
from upswing.study.ids import CellId
from upswing.study.paths import RUNS, STUDY


class Chosen(NamedTuple):
    """Runs of a study that are browsed."""

    study: str  # what it is called: the name of its folder
    results: Results
    runs: pd.DataFrame  # rows of its table of runs; at least one


class Choice(NamedTuple):
    """What is browsed of a folder."""

    chosen: list[Chosen]
    remarks: list[str]  # what is left out, and why


def studies_in(folder: Path) -> list[Results]:
    """The study in a folder of results, and those in folders right below it that have been run.

    The first may be missing; a reader of it says so. What the history keeps are tables without
    recordings, and they are no such studies.
    """
    below = sorted(path.parent for path in folder.glob(f"*/{STUDY}"))
    found = [Results(path) for path in below if (path / RUNS).is_file()]
    alone = (folder / STUDY).is_file() or not found
    return [Results(folder), *found] if alone else found


def choose(folder: Path, words: Sequence[str]) -> Choice:
    """The runs of every study of a folder that fulfil every word; identical cells once.

    Raises:
        BadInput: no study has such runs, with what is wrong in the first; or the first cannot be read.
    """
    chosen, remarks, problems = [], [], []
    for number, results in enumerate(studies_in(folder)):
        name = results.folder.resolve().name
        problem = _unreadable(results)
        if problem is not None and number == 0:
            raise problem
        if problem is not None:
            remarks.append(f"{name} is left out: {problem.problems[0]}")
            continue
        try:
            runs = select(results, words)
        except BadInput as error:
            problems += error.problems
            continue
        if number and (lost := _without_recording(results, runs)):
            remarks.append(f"{name} is left out: {lost:,} of {len(runs):,} runs have no recording")
        else:
            chosen.append(Chosen(name, results, runs))
    if not chosen:
        raise BadInput(problems[:1])
    return _once(chosen, remarks)


def _unreadable(results: Results) -> BadInput | None:
    """What is wrong with the table of runs of a study."""
    try:
        results.check_measures(results.runs, ["seed"])
    except BadInput as error:
        return error
    return None


def _without_recording(results: Results, runs: pd.DataFrame) -> int:
    return sum(not (results.folder / path).is_file() for path in runs["recording"])


def _once(chosen: list[Chosen], remarks: list[str]) -> Choice:
    """Without the cells whose every run another cell has as well."""
    cells = {
        (one.study, str(cell)): runs_of(rows)
        for one in chosen
        for cell, rows in one.runs.groupby("cell", sort=False)
    }
    shown = once(cells)
    pairs = Counter(
        (study, CellId.parse(cell).architecture, where, CellId.parse(whole).architecture)
        for (where, whole), others in shown.items()
        for study, cell in others
    )
    remarks = remarks + [
        f"{study}: {architecture} is listed once, as {whole}{'' if where == study else f' of {where}'}"
        f" ({count} {'cell' if count == 1 else 'cells'}): the runs are the same, bit for bit"
        for (study, architecture, where, whole), count in pairs.items()
    ]
    left = [
        one._replace(runs=one.runs[[(one.study, cell) in shown for cell in one.runs["cell"]]])
        for one in chosen
    ]
    return Choice([one for one in left if len(one.runs)], remarks)
