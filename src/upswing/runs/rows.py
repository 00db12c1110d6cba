"""The rows of the table of runs, read from the runs' own files."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pandas as pd

from upswing.runs.files.tables import NULLABLE
from upswing.runs.files.trajectory import read_metadata
from upswing.study.errors import BadInput
from upswing.study.ids import file_of, recording_of
from upswing.study.spec import Spec


def collected(results: Path, cells: Iterable[Spec]) -> pd.DataFrame:
    """One row for each run of ``cells``, in their order.

    Raises:
        BadInput: runs are missing, or are of other specifications; it names them.
    """
    rows, problems = [], []
    for cell in cells:
        for seed, text in cell.canonical_runs():
            path = results / file_of(cell.run(seed), "windows.parquet")
            try:
                if not path.exists():
                    raise BadInput([f"{path}: missing; run the study again to make it"])
                found = read_metadata(path)
                if found["spec"] != text:
                    raise BadInput([f"{path}: is of another specification: {found['spec']}"])
                rows.append(row_of(cell, seed, found))
            except BadInput as error:
                problems += error.problems
    if problems:
        raise BadInput(problems)
    return framed(rows)


def framed(rows: Iterable[dict[str, Any]]) -> pd.DataFrame:
    """Rows of runs as a table."""
    frame = pd.DataFrame(list(rows))
    return frame.astype({name: kind for name, kind in NULLABLE.items() if name in frame})


def row_of(cell: Spec, seed: int, found: dict[str, Any]) -> dict[str, Any]:
    """The row of a run of ``cell``, from the metadata of its windows."""
    made = found["provenance"]
    return {
        **cell.columns(seed),
        **found["outcome"],
        "recording": recording_of(cell.run(seed)),
        "git_commit": made["git_commit"],
        "dirty": made["dirty"],
        "spec": found["spec"],
    }
