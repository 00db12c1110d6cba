"""What solving full control is: when a run gets up, whether it stays, and what it knows."""

from typing import Any

import pandas as pd

from upswing.analysis import statistics, survival
from upswing.runs.success import SUCCESS
from upswing.study.matrix import Matrix

Row = dict[str, Any]


def solving(runs: pd.DataFrame, matrix: Matrix) -> list[Row]:
    """A row for each cell of full control, of the runs that stayed finite.

    ``captured``: how many were upright for 5,000 steps at least once, ``capture`` the median step by
    Kaplan and Meier (with ``capture_low``, ``capture_high``), runs that never were being censored.
    ``kept``: how many of those stand at the end. ``standing``: how many of all do. ``frozen``: the mean
    share of starts all around from which what was learned succeeds without exploring, and ``frozen_all``
    how many runs succeed from all of them. ``cost``: −r in the last fifth [rad²], with its interval.
    """
    rows = []
    for cell, spec in matrix.cells.items():
        if spec.task.judged_by != "upright":
            continue
        own = runs[runs["run"].str.rpartition("/")[0] == cell]
        finite = own[own["diverged_at"].isna()]
        times = [None if pd.isna(time) else float(time) for time in finite["first_stable_step"]]
        middle, low, high = survival.median_time(times, float(spec.task.steps))
        stands = finite["upright_at_end"] >= SUCCESS
        captured = finite["first_stable_step"].notna()
        cost = statistics.mean(-finite["mean_reward"].to_numpy(float))
        rows.append(
            {
                "cell": cell,
                "learns": spec.architecture.learns,
                "runs": len(finite),
                "diverged": len(own) - len(finite),
                "captured": int(captured.sum()),
                "capture": middle,
                "capture_low": low,
                "capture_high": high,
                "kept": int((stands & captured).sum()),
                "standing": int(stands.sum()),
                "frozen": float(finite["greedy_success_share"].mean()),
                "frozen_all": int((finite["greedy_success_share"] == 1).sum()),
                "cost": cost.value,
                "cost_low": cost.low,
                "cost_high": cost.high,
            }
        )
    return rows
