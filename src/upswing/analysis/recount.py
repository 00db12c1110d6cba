"""Tables made again from what they come from, and held against those that are there.

A checksum shows damage; a table that somebody edited together with its checksum shows only here.
"""

import json
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from upswing.analysis.ablation import changes
from upswing.analysis.aggregate import summarise
from upswing.analysis.beyond_tables import OF_A_CANDIDATE, OF_A_CHANGE, OF_THE_CHOSEN
from upswing.analysis.search import chosen
from upswing.analysis.verdicts import judge_all
from upswing.runs.adopted import with_origin
from upswing.runs.files.ledger import ledger_path, read_ledger
from upswing.runs.files.tables import read_cells, read_evidence, read_runs, read_verdicts
from upswing.runs.files.typed_table import read_table
from upswing.runs.results import Results
from upswing.runs.rows import framed, row_of
from upswing.study.claims import Claim, canonical_claims
from upswing.study.errors import BadInput
from upswing.study.ids import cell_of
from upswing.study.matrix import Matrix
from upswing.study.paths import (
    CELLS,
    CHANGES,
    CHOSEN,
    EVIDENCE,
    LEDGER_OF_VERDICTS,
    RUNS,
    SHORTEST,
    VERDICTS,
)

ALIKE = 1e-9
"""Relative difference that statistics may have from machine to machine."""

Wrong = tuple[str, str]  # a table, and what is wrong with it


class Recounted(Results):
    """Results whose table of runs is made from the runs themselves."""

    def __init__(self, folder: Path, runs: pd.DataFrame) -> None:
        super().__init__(folder)
        cells = runs["run"].map(cell_of)
        self.__dict__.update(runs=runs.assign(cell=cells))


def recount(
    results: Path,
    matrix: Matrix,
    found: Mapping[str, dict[str, Any]],
    claims: Mapping[str, Claim] | None,
) -> Iterator[Wrong]:
    """What is wrong with the tables of a folder whose every run is there.

    Args:
        results: the folder.
        matrix: that of its study.
        found: the metadata of every run's windows, by the runs' ids.
        claims: those to judge by; without, or with others than were judged by, verdicts are left out.
    """
    runs = framed(
        row_of(cell, seed, found[cell.run(seed)])
        for cell in matrix.cells.values()
        for seed in cell.seeds
    )
    runs = with_origin(runs, matrix.cells)
    there = Recounted(results, runs)
    yield from _held(RUNS, lambda: read_runs(results, list(matrix.runs)), lambda: runs)
    yield from _held(CELLS, lambda: read_cells(results, matrix.cells), lambda: summarise(runs))
    if claims is not None and judged_by(results) == canonical_claims(claims):
        verdicts, evidence = judge_all(there, claims, _over(results))
        yield from _held(VERDICTS, lambda: read_verdicts(results), lambda: verdicts)
        yield from _held(EVIDENCE, lambda: read_evidence(results), lambda: evidence)
    if (path := results / CHANGES).is_file():
        yield from _held(CHANGES, lambda: read_table(path, OF_A_CHANGE, ""), lambda: changes(there))
    if (searched := results / SHORTEST).is_file() and (best := results / CHOSEN).is_file():
        yield from _held(
            CHOSEN,
            lambda: read_table(best, OF_THE_CHOSEN, ""),
            lambda: chosen(read_table(searched, OF_A_CANDIDATE, "")),
        )


def judged_by(results: Path) -> str | None:
    """The claims by which the verdicts of a folder were judged, as one line; None if nobody knows."""
    try:
        return read_ledger(ledger_path(results, LEDGER_OF_VERDICTS)).made_from.get("claims")
    except BadInput:
        return None


def _over(results: Path) -> dict[str, Any]:
    """What the readings said of each claim when it was judged."""
    found: dict[str, Any] = json.loads(
        read_ledger(ledger_path(results, LEDGER_OF_VERDICTS)).made_from.get("readings", "{}")
    )
    return found


def _held(
    table: str, read: Callable[[], pd.DataFrame], made: Callable[[], pd.DataFrame]
) -> Iterator[Wrong]:
    """A table as it is against the same made anew."""
    try:
        again = made()
    except BadInput:
        return  # what it is made from is damaged, and named for itself
    try:
        there = read()
    except BadInput as error:
        yield table, error.problems[0].partition(f"{table}: ")[2].rpartition(";")[0]
        return
    if difference := _difference(there, again):
        yield table, f"is not what its runs come to: {difference}"


def _difference(there: pd.DataFrame, again: pd.DataFrame) -> str:
    """The first difference between two tables in words; empty if there is none."""
    if list(there.columns) != list(again.columns):
        other = sorted(set(there.columns) ^ set(again.columns)) or list(there.columns)
        return f"it has other columns ({other[0]})"
    if len(there) != len(again):
        return f"it has {len(there)} rows in place of {len(again)}"
    for name in there.columns:
        same = _same(there[name], again[name])
        if not same.all():
            row = int(np.argmin(same))
            said, right = there[name].iloc[row], again[name].iloc[row]
            return f"row {row} has {name} {said} in place of {right}"
    return ""


def _same(one: pd.Series, other: pd.Series) -> np.ndarray[Any, np.dtype[np.bool_]]:
    if all(pd.api.types.is_numeric_dtype(column) for column in (one, other)):
        a, b = (column.to_numpy(float, na_value=np.nan) for column in (one, other))
        return np.asarray(np.isclose(a, b, rtol=ALIKE, atol=1e-12, equal_nan=True), dtype=np.bool_)
    pairs = zip(one, other, strict=True)
    return np.array([_text(a) == _text(b) for a, b in pairs], dtype=np.bool_)


def _text(value: Any) -> str:
    return str(list(value)) if isinstance(value, list | np.ndarray) else str(value)
