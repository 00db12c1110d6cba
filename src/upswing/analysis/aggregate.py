"""Runs → one row a run → one row a cell."""

from pathlib import Path
from typing import Any

import pandas as pd

from upswing.analysis import statistics, survival
from upswing.runs.adopted import with_origin
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import MEASURES, write_table
from upswing.runs.rows import collected
from upswing.runs.success import SUCCESS
from upswing.study.ids import cell_of
from upswing.study.matrix import Matrix
from upswing.study.paths import CELLS, RUNS


def write_tables(results: Path, matrix: Matrix) -> None:
    """Write ``runs.parquet`` and ``cells.parquet`` of the runs of ``matrix`` below ``results``.

    Raises:
        BadInput: runs are missing, or are not those of the matrix; it names them.
    """
    runs = with_origin(collected(results, matrix.cells.values()), matrix.cells)
    write_table(results / RUNS, runs)
    write_table(results / CELLS, summarise(runs))
    seal(results, "tables", [results / RUNS, results / CELLS])


def summarise(runs: pd.DataFrame) -> pd.DataFrame:
    """One row for each cell of ``runs``, in their order; runs that diverged are counted apart.

    Of every measure mean, median and interquartile mean, each with its 95 % interval (``_low``,
    ``_high``): how sure the estimate is; and the 5th and 95th percentile of the runs (``_p05``,
    ``_p95``): how they differ. ``runs_kept``: of those that became stable, how many stand at the end;
    ``frozen_…``: what was learned, followed without exploring. The time to stability is Kaplan–Meier's,
    runs that never got there being censored.
    """
    rows = []
    for (task, architecture, alpha), every in runs.groupby(
        ["task", "architecture", "alpha"], sort=False, dropna=False
    ):
        group = every[every["diverged_at"].isna()]
        stands = group["upright_at_end"] >= SUCCESS
        row: dict[str, Any] = {
            "cell": cell_of(every["run"].iloc[0]),
            "task": task,
            "architecture": architecture,
            "alpha": alpha,
            "steps": every["steps"].iloc[0],
            "runs": len(group),
            "runs_diverged": len(every) - len(group),
            "runs_stable": int(group["first_stable_step"].notna().sum()),
            "runs_without_fall_in_last_fifth": int((group["falls_last_fifth"] == 0).sum()),
            "runs_upright": int((group["upright_share"] >= SUCCESS).sum()),
            "runs_upright_at_end": int(stands.sum()),
            "runs_kept": int((stands & group["first_stable_step"].notna()).sum()),
            "frozen_success_share": float(group["greedy_success_share"].mean()),
            "runs_frozen_all": int((group["greedy_success_share"] == 1).sum()),
        }
        times = [None if pd.isna(time) else float(time) for time in group["first_stable_step"]]
        middle = survival.median_time(times, float(row["steps"]))
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
        row["steps_per_second_median"] = every["steps_per_second"].median()
        rows.append(row)
    return pd.DataFrame(rows)
