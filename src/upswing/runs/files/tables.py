"""The tables of a study: where they stand, what is in them, how they are written and read back."""

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.parquet as pq

from upswing.runs.endings import PERCENT
from upswing.runs.files.atomic import written
from upswing.runs.files.provenance import metadata
from upswing.runs.files.typed_table import Columns, read_table
from upswing.study.errors import BadInput
from upswing.study.ids import recording_of
from upswing.study.paths import CELLS, EVIDENCE, RUNS, VERDICTS

if TYPE_CHECKING:
    import pandas as pd

NULLABLE = {
    "alpha": "float64",
    "first_stable_step": "Int64",
    "falls_after_stable": "Int64",
    "arrival_speed": "float64",
    "too_fast_share": "float64",
    "recovered_share": "float64",
    "diverged_at": "Int64",
    **{f"recovered_last_{percent}": "float64" for percent in PERCENT},
}
"""Columns that are empty for some runs."""

MEASURES = (
    "falls",
    "falls_last_fifth",
    "upright_share",
    "above_horizontal_share",
    "mean_reward",
    "upright_at_end",
)
"""What a cell is summed up by."""

LOCATIONS = ("mean", "median", "interquartile_mean")
"""Where the middle of a measure is, in three senses."""

JUDGED = ("reproduced", "partly", "inconclusive", "not reproduced", "not in this study")
"""What a verdict may be."""

OF_A_RUN: Columns = {
    "run": "text", "seed": "whole", "steps": "whole", "recording": "text", "digest": "text",
    "diverged_at": "whole?",
}  # fmt: skip
"""What every table of runs has; its measures are asked for where they are used."""

OF_A_CELL: Columns = {
    "cell": "text", "task": "text", "architecture": "text", "alpha": "number", "steps": "whole",
    "runs": "whole", "runs_diverged": "whole", "runs_stable": "whole",
    "runs_without_fall_in_last_fifth": "whole",
    "runs_upright": "whole", "runs_upright_at_end": "whole", "runs_kept": "whole",
    "frozen_success_share": "number", "runs_frozen_all": "whole", "steps_per_second_median": "number",
    **{f"first_stable_step_{part}": "number" for part in ("median", "low", "high")},
    **{
        f"{measure}_{part}": "number"
        for measure in MEASURES
        for location in LOCATIONS
        for part in (location, f"{location}_low", f"{location}_high", "p05", "p95")
    },
}  # fmt: skip

OF_A_VERDICT: Columns = {
    "claim": "text", "statement": "text", "section": "text", "measure": "text", "threshold": "text",
    "estimate": "number", "low": "number", "high": "number", "n": "whole", "method": "text",
    "cells": "text", "verdict": "text", "could_be_better": "truth", "at_threshold": "truth",
    "diverged": "whole", "check": "text",
    "spread_low": "number", "spread_high": "number", "note": "text", "parts": "whole",
    "figure": "whole?", "recordings": "texts", "held_share": "number", "weighted_share": "number",
    "weighted_low": "number", "weighted_high": "number", "grade": "text?", "fragile": "truth",
    "fragile_because": "text",
}  # fmt: skip

OF_A_COMPARISON: Columns = {
    "claim": "text", "part": "whole", "says": "text", "cells": "text", "measure": "text",
    "threshold": "text", "holds_from": "number", "partly_from": "number", "at_least": "truth",
    "estimate": "number", "low": "number", "high": "number", "n": "whole", "method": "text",
    "spread_low": "number", "spread_high": "number", "verdict": "text",
    "could_be_better": "truth", "at_threshold": "truth", "diverged": "whole", "because": "text",
}  # fmt: skip


def write_table(path: Path, frame: "pd.DataFrame") -> None:
    """Write a table with its provenance."""
    table = pa.Table.from_pandas(frame, preserve_index=False)
    described = {**(table.schema.metadata or {}), **metadata()}
    with written(path) as beside:
        pq.write_table(table.replace_schema_metadata(described), beside, compression="zstd")


def read_runs(results: Path, runs: Collection[str], more: Columns | None = None) -> "pd.DataFrame":
    """The table of runs, with those columns ``more``; each of its rows is one of ``runs``.

    Raises:
        BadInput: it is missing, is no such table, or has rows of other runs.
    """
    path, remedy = results / RUNS, f"`upswing tables {results}` makes it"
    frame = read_table(path, {**OF_A_RUN, **(more or {})}, remedy)
    known = set(runs)
    for run, recording in zip(frame["run"], frame["recording"], strict=True):
        if run not in known:
            raise BadInput([f"{path}: {run}: is no run of this study; {remedy}"])
        if recording != recording_of(run):
            raise BadInput([f"{path}: {run}: {recording}: is not its recording; {remedy}"])
    _once(path, frame, ["run"], remedy)
    return frame


def read_cells(results: Path, cells: Collection[str]) -> "pd.DataFrame":
    """The table of cells; there is one row for each of ``cells``."""
    path, remedy = results / CELLS, f"`upswing tables {results}` makes it"
    frame = read_table(path, OF_A_CELL, remedy)
    _once(path, frame, ["cell"], remedy)
    if other := set(frame["cell"]) ^ set(cells):
        raise BadInput([f"{path}: {min(other)}: is in the study or in the table only; {remedy}"])
    return frame


def read_verdicts(results: Path) -> "pd.DataFrame":
    """The table of verdicts."""
    path, remedy = results / VERDICTS, f"`upswing verdicts {results}` makes it"
    frame = read_table(path, OF_A_VERDICT, remedy)
    _once(path, frame, ["claim"], remedy)
    _judged(path, frame, remedy)
    return frame


def read_evidence(results: Path) -> "pd.DataFrame":
    """The table of evidence."""
    path, remedy = results / EVIDENCE, f"`upswing verdicts {results}` makes it"
    frame = read_table(path, OF_A_COMPARISON, remedy)
    _once(path, frame, ["claim", "part", "cells"], remedy)
    _judged(path, frame, remedy)
    return frame


def _once(path: Path, frame: "pd.DataFrame", key: list[str], remedy: str) -> None:
    twice = frame.loc[frame.duplicated(key), key]
    if len(twice):
        words = ", ".join(str(value) for value in twice.iloc[0])
        raise BadInput([f"{path}: {words}: is there twice; {remedy}"])


def _judged(path: Path, frame: "pd.DataFrame", remedy: str) -> None:
    if len(other := frame.loc[~frame["verdict"].isin(JUDGED), "verdict"]):
        raise BadInput([f"{path}: {other.iloc[0]}: is no verdict; {remedy}"])
