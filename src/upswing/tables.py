"""Runs → one row a run → one row a cell."""

from collections.abc import Collection, Iterable
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from upswing import statistics
from upswing.matrix import Matrix
from upswing.problems import BadInput
from upswing.spec import parse
from upswing.store.files import written
from upswing.store.ledger import seal
from upswing.store.provenance import metadata
from upswing.store.table import Columns, read_table
from upswing.store.trajectory import read_metadata
from upswing.success import SUCCESS

RUNS = "tables/runs.parquet"
CELLS = "tables/cells.parquet"
VERDICTS = "tables/verdicts.parquet"
EVIDENCE = "tables/evidence.parquet"

NULLABLE = {
    "alpha": "float64",
    "first_stable_step": "Int64",
    "falls_after_stable": "Int64",
    "arrival_speed": "float64",
    "too_fast_share": "float64",
    "recovered_share": "float64",
}
"""Columns that are empty for some runs."""

MEASURES = (
    "falls",
    "falls_last_fifth",
    "upright_share",
    "above_horizontal_share",
    "mean_reward",
)
"""What a cell is summed up by."""

JUDGED = ("reproduced", "partly", "inconclusive", "not reproduced", "not in this study")
"""What a verdict may be."""

OF_A_RUN: Columns = {
    "run": "text", "seed": "whole", "steps": "whole", "recording": "text", "digest": "text",
}  # fmt: skip
"""What every table of runs has; its measures are asked for where they are used."""

OF_A_CELL: Columns = {
    "cell": "text", "task": "text", "architecture": "text", "alpha": "number", "steps": "whole",
    "runs": "whole", "runs_stable": "whole", "runs_without_fall_in_last_fifth": "whole",
    "runs_upright": "whole", "steps_per_second_median": "number",
    **{f"first_stable_step_{part}": "number" for part in ("median", "low", "high")},
    **{
        f"{measure}_{part}": "number"
        for measure in MEASURES
        for location in statistics.LOCATIONS
        for part in (location, f"{location}_low", f"{location}_high", "p05", "p95")
    },
}  # fmt: skip

OF_A_VERDICT: Columns = {
    "claim": "text", "statement": "text", "section": "text", "measure": "text", "threshold": "text",
    "estimate": "number", "low": "number", "high": "number", "n": "whole", "method": "text",
    "cells": "text", "p_value": "number", "verdict": "text", "could_be_better": "truth",
    "spread_low": "number", "spread_high": "number", "note": "text", "parts": "whole",
    "figure": "whole?", "recordings": "texts", "p_holm": "number",
}  # fmt: skip

OF_A_COMPARISON: Columns = {
    "claim": "text", "part": "whole", "says": "text", "cells": "text", "measure": "text",
    "threshold": "text", "holds_from": "number", "partly_from": "number", "at_least": "truth",
    "estimate": "number", "low": "number", "high": "number", "n": "whole", "method": "text",
    "spread_low": "number", "spread_high": "number", "p_value": "number", "verdict": "text",
    "could_be_better": "truth", "because": "text",
}  # fmt: skip


def write_tables(results: Path, matrix: Matrix) -> None:
    """Write ``runs.parquet`` and ``cells.parquet`` of the runs of ``matrix`` below ``results``.

    Raises:
        BadInput: runs are missing, or are not those of the matrix; it names them.
    """
    runs = collect_runs(results, matrix)
    write_table(results / RUNS, runs)
    write_table(results / CELLS, summarise(runs))
    seal(results, "tables", [results / RUNS, results / CELLS])


def collect_runs(results: Path, matrix: Matrix) -> pd.DataFrame:
    """One row for each run of ``matrix``, in its order."""
    found, problems = [], []
    for cell in matrix.cells.values():
        for seed in cell.seeds:
            path = results / "runs" / f"{cell.run(seed)}.windows.parquet"
            try:
                if not path.exists():
                    raise BadInput([f"{path}: missing; run the study again to make it"])
                if (content := read_metadata(path))["spec"] != cell.of_seed(seed).canonical():
                    raise BadInput([f"{path}: is of another specification: {content['spec']}"])
                found.append(content)
            except BadInput as error:
                problems += error.problems
    if problems:
        raise BadInput(problems)
    return runs_of(found)


def runs_of(found: Iterable[dict[str, Any]]) -> pd.DataFrame:
    """One row for each run, from the metadata of its windows."""
    return pd.DataFrame([_row(content) for content in found]).astype(NULLABLE)


def summarise(runs: pd.DataFrame) -> pd.DataFrame:
    """One row for each cell of ``runs``, in their order.

    Of every measure mean, median and interquartile mean, each with its 95 % interval (``_low``,
    ``_high``): how sure the estimate is; and the 5th and 95th percentile of the runs (``_p05``,
    ``_p95``): how they differ. The time to stability is Kaplan–Meier's, runs that never got there
    being censored.
    """
    rows = []
    for (task, architecture, alpha), group in runs.groupby(
        ["task", "architecture", "alpha"], sort=False, dropna=False
    ):
        row: dict[str, Any] = {
            "cell": group["run"].iloc[0].rsplit("/", 1)[0],
            "task": task,
            "architecture": architecture,
            "alpha": alpha,
            "steps": group["steps"].iloc[0],
            "runs": len(group),
            "runs_stable": int(group["first_stable_step"].notna().sum()),
            "runs_without_fall_in_last_fifth": int((group["falls_last_fifth"] == 0).sum()),
            "runs_upright": int((group["upright_share"] >= SUCCESS).sum()),
        }
        times = [None if pd.isna(time) else float(time) for time in group["first_stable_step"]]
        middle = statistics.median_time(times, float(row["steps"]))
        for name, value in zip(("median", "low", "high"), middle, strict=True):
            row[f"first_stable_step_{name}"] = value
        for measure in MEASURES:
            for location, estimated in statistics.LOCATIONS.items():
                estimate = estimated(group[measure].to_numpy())
                row[f"{measure}_{location}"] = estimate.value
                row[f"{measure}_{location}_low"] = estimate.low
                row[f"{measure}_{location}_high"] = estimate.high
            row[f"{measure}_p05"], row[f"{measure}_p95"] = statistics.spread(
                group[measure].to_numpy()
            )
        row["steps_per_second_median"] = group["steps_per_second"].median()
        rows.append(row)
    return pd.DataFrame(rows)


def _row(found: dict[str, Any]) -> dict[str, Any]:
    spec = parse(found["spec"])
    outcome, made = found["outcome"], found["provenance"]
    return {
        **spec.columns(spec.seeds[0]),
        **outcome,
        "recording": f"runs/{found['run']}.rrd",
        "git_commit": made["git_commit"],
        "dirty": made["dirty"],
        "spec": found["spec"],
    }


def write_table(path: Path, frame: pd.DataFrame) -> None:
    """Write a table with its provenance."""
    table = pa.Table.from_pandas(frame, preserve_index=False)
    described = {**(table.schema.metadata or {}), **metadata()}
    with written(path) as beside:
        pq.write_table(table.replace_schema_metadata(described), beside, compression="zstd")


def read_runs(results: Path, runs: Collection[str], more: Columns | None = None) -> pd.DataFrame:
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
        if recording != f"runs/{run}.rrd":
            raise BadInput([f"{path}: {run}: {recording}: is not its recording; {remedy}"])
    _once(path, frame, ["run"], remedy)
    return frame


def read_cells(results: Path, cells: Collection[str]) -> pd.DataFrame:
    """The table of cells; there is one row for each of ``cells``."""
    path, remedy = results / CELLS, f"`upswing tables {results}` makes it"
    frame = read_table(path, OF_A_CELL, remedy)
    _once(path, frame, ["cell"], remedy)
    if other := set(frame["cell"]) ^ set(cells):
        raise BadInput([f"{path}: {min(other)}: is in the study or in the table only; {remedy}"])
    return frame


def read_verdicts(results: Path) -> pd.DataFrame:
    """The table of verdicts."""
    path, remedy = results / VERDICTS, f"`upswing verdicts {results}` makes it"
    frame = read_table(path, OF_A_VERDICT, remedy)
    _once(path, frame, ["claim"], remedy)
    _judged(path, frame, remedy)
    return frame


def read_evidence(results: Path) -> pd.DataFrame:
    """The table of evidence."""
    path, remedy = results / EVIDENCE, f"`upswing verdicts {results}` makes it"
    frame = read_table(path, OF_A_COMPARISON, remedy)
    _once(path, frame, ["claim", "part", "cells"], remedy)
    _judged(path, frame, remedy)
    return frame


def _once(path: Path, frame: pd.DataFrame, key: list[str], remedy: str) -> None:
    twice = frame.loc[frame.duplicated(key), key]
    if len(twice):
        words = ", ".join(str(value) for value in twice.iloc[0])
        raise BadInput([f"{path}: {words}: is there twice; {remedy}"])


def _judged(path: Path, frame: pd.DataFrame, remedy: str) -> None:
    if len(other := frame.loc[~frame["verdict"].isin(JUDGED), "verdict"]):
        raise BadInput([f"{path}: {other.iloc[0]}: is no verdict; {remedy}"])
