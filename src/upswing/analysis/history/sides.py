"""What a study came to, read for comparing: from a folder of results, or from an entry of a history."""

import hashlib
import json
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from upswing.runs.files.ledger import ledger_path, read_ledger
from upswing.runs.files.typed_table import Columns, read_table
from upswing.runs.study_file import parse_study
from upswing.study import history_paths, paths
from upswing.study.errors import BadInput

if TYPE_CHECKING:
    import pandas as pd

OF_A_COMPARED: Columns = {
    "claim": "text", "part": "whole", "cells": "text", "estimate": "number", "low": "number",
    "high": "number",
}  # fmt: skip
"""What comparisons are compared by."""

DIGITS = 6
"""Significant digits by which numbers are the same: the last ones differ from machine to machine."""

TIMED = ("steps_per_second_median",)
"""Columns of cells that are never the same twice."""

NOT_ASKED = ("results", "claims")
"""Keys of a study that say where it, or what it is judged by, is kept: not what is asked."""


class Side(NamedTuple):
    """A study, as it is compared with others."""

    label: str  # how it was called for
    place: str  # which one that is
    configuration: Mapping[str, Any] | None  # the study and its claims; None where nobody knows
    runs: "pd.DataFrame"  # run, digest …
    cells: "pd.DataFrame | None"  # None where there is no such table
    verdicts: "pd.DataFrame"
    evidence: "pd.DataFrame"


def of_folder(folder: Path) -> Side:
    """The study in a folder of results.

    Raises:
        BadInput: the folder lacks a table, or has one that is empty or of another origin.
    """
    judge, tables = f"`upswing verdicts {folder}` makes it", f"`upswing tables {folder}` makes it"
    verdicts = read_table(folder / paths.VERDICTS, {"claim": "text", "verdict": "text"}, judge)
    evidence = read_table(folder / paths.EVIDENCE, OF_A_COMPARED, judge)
    runs = read_table(folder / paths.RUNS, {"run": "text", "digest": "text"}, tables)
    cells = None
    if (folder / paths.CELLS).is_file():
        cells = read_table(folder / paths.CELLS, {"cell": "text"}, tables)
    return Side(
        label=str(folder),
        place=f"the results in {folder}",
        configuration=_configuration(_text(folder / paths.STUDY), claims_of(folder)),
        runs=runs,
        cells=cells,
        verdicts=verdicts,
        evidence=evidence,
    )


def of_entry(results: Path, entry: str, label: str = "", place: str = "") -> Side:
    """The study of an entry of the history of ``results``, by its id.

    Raises:
        BadInput: a table of it is missing or damaged.
    """
    folder = results / history_paths.folder_of(entry)
    remedy = f"`upswing doctor {results}` says what is damaged"

    def table(name: str, columns: Columns) -> "pd.DataFrame":
        return read_table(folder / name, columns, remedy)

    return Side(
        label=label or entry,
        place=place or f"entry {entry} of the history of {results}",
        configuration=_configuration(
            _text(folder / history_paths.STUDY), _text(folder / history_paths.CLAIMS)
        ),
        runs=table(history_paths.RUNS, {"run": "text", "digest": "text"}),
        cells=table(history_paths.CELLS, {"cell": "text"}),
        verdicts=table(history_paths.VERDICTS, {"claim": "text", "verdict": "text"}),
        evidence=table(history_paths.EVIDENCE, OF_A_COMPARED),
    )


def digest(side: Side) -> str:
    """32 hexadecimal digits that are the same for studies that ask and come to the same.

    Neither the commit nor the machine nor the time is in it.
    """
    content = {
        "configuration": side.configuration,
        "runs": sorted(zip(side.runs["run"], side.runs["digest"], strict=True)),
        "cells": None if side.cells is None else rounded(side.cells),
        "verdicts": rounded(side.verdicts),
        "evidence": rounded(side.evidence),
    }
    text = json.dumps(content, sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def rounded(frame: "pd.DataFrame") -> list[dict[str, str]]:
    """The rows of a table as texts, numbers to ``DIGITS`` digits, without what is never the same."""
    kept = frame[[name for name in frame.columns if name not in TIMED]]
    return [
        {str(name): _rounded(value) for name, value in row.items()}
        for row in kept.to_dict("records")
    ]


def _rounded(value: Any) -> str:
    return f"{value:.{DIGITS}g}" if isinstance(value, float) else str(value)


def claims_of(folder: Path) -> str | None:
    """The claims that the verdicts of a folder of results were judged by, as JSON; None if unknown."""
    try:
        return read_ledger(ledger_path(folder, paths.LEDGER_OF_VERDICTS)).made_from["claims"]
    except (BadInput, KeyError):
        return None


def _text(path: Path) -> str | None:
    try:
        return path.read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return None


def _configuration(study: str | None, claims: str | None) -> Mapping[str, Any] | None:
    """A study and its claims as plain values; what an older version did not know has its default."""
    asked = _values(study)
    if asked is None:
        return None
    with suppress(BadInput):  # of a version whose keys are others: compared as it was written
        asked = parse_study(json.dumps(asked), paths.STUDY).model_dump(mode="json")
    asked = {key: value for key, value in asked.items() if key not in NOT_ASKED}
    judged = _values(claims)
    return asked if judged is None else {**asked, "claims": judged}


def _values(text: str | None) -> dict[str, Any] | None:
    try:
        found = json.loads(text) if text is not None else None
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None
