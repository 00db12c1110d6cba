"""What each change buys: a row for every cell of an experiment that has a title."""

from math import nan
from pathlib import Path
from typing import Any

import pandas as pd

from upswing.analysis import statistics, survival
from upswing.optimal.tables import OF_THE_BOUND
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.runs.files.typed_table import read_table
from upswing.runs.results import Results
from upswing.runs.success import succeeds
from upswing.study.config import pendulum_of_bound
from upswing.study.errors import BadInput
from upswing.study.matrix import cells_of
from upswing.study.paths import BOUND, CHANGES
from upswing.study.spec import Spec

EVERY_TIME = 0.95
"""The share of upright steps in the last fifth that a learner of full control is asked for."""

MEASURED = (
    "falls_last_fifth", "upright_share", "first_stable_step", "seconds", "steps", "mean_reward",
)  # fmt: skip


def write_changes(results: Path) -> pd.DataFrame:
    """Write and return ``changes.parquet`` of a folder whose bound is known."""
    frame = changes(Results(results))
    write_table(results / CHANGES, frame)
    seal(results, "changes", [results / CHANGES])
    return frame


def changes(results: Results) -> pd.DataFrame:
    """A row for every cell of an experiment that has a title."""
    bound = _bound(results.folder)
    results.check_measures(results.runs, MEASURED)
    return pd.DataFrame(
        [
            {"change": experiment.title, **_row(results, results.cells[cell], bound)}
            for experiment in results.study.experiments
            if experiment.title
            for cell in cells_of(experiment)
        ]
    )


def _row(results: Results, spec: Spec, bound: dict[str, float]) -> dict[str, Any]:
    runs, task, horizon = results.counted(spec.cell), spec.task, float(spec.task.steps)
    # The bound is that of one pendulum; of another nothing is known.
    solved = pendulum_of_bound(results.study)
    possible = bound["upright_share"] if task.pendulum == solved else nan
    success = succeeds(runs, task)
    rate = statistics.share(int(success.sum()), len(success))
    upright = statistics.mean(runs["upright_share"].to_numpy(float))
    times = [None if pd.isna(step) else float(step) for step in runs["first_stable_step"]]
    median, earliest, latest = survival.median_time(times, horizon)
    return {
        "cell": spec.cell,
        "task": spec.task.name,
        "kind": task.kind,
        "steps": spec.task.steps,
        "architecture": spec.architecture.name,
        "alpha": spec.alpha,
        "discount": spec.discount,
        "epsilon": spec.epsilon,
        "runs": len(runs),
        "successes": int(success.sum()),
        "success": rate.value,
        "success_low": rate.low,
        "success_high": rate.high,
        # Of balancing, runs that did not fall; of full control, runs upright nearly all the time.
        "sure": int(
            success.sum()
            if task.judged_by == "falls"
            else (runs["upright_share"] >= EVERY_TIME).sum()
        ),
        "stable": sum(time is not None for time in times),
        "stable_step": median,  # infinite where half of the runs never were stable
        "stable_low": earliest,
        "stable_high": latest,
        "nanoseconds": float((runs["seconds"] / runs["steps"]).median() * 1e9),
        "upright": upright.value,
        "missing": possible - upright.value,
        "missing_low": possible - upright.high,
        "missing_high": possible - upright.low,
        "cost": -float(runs["mean_reward"].mean()),
        "median_run": results.three_of(spec.cell).iloc[1]["run"],
    }


def _bound(results: Path) -> dict[str, float]:
    """What the fastest policy comes to under the study's own conditions, ε = 0.01 included."""
    path = results / BOUND
    remedy = f"`upswing bound {results}` makes it"
    frame = read_table(path, OF_THE_BOUND, remedy)
    rows = frame[(frame["policy"] == "fastest") & frame["quantity"].str.startswith("explored_")]
    found = {
        str(quantity).removeprefix("explored_"): float(value)
        for quantity, value in zip(rows["quantity"], rows["value"], strict=True)
    }
    if "upright_share" not in found:
        raise BadInput([f"{path}: explored_upright_share: is not in it; {remedy}"])
    return found
