"""What came out in a study of one's own: a row for each cell, in numbers with their intervals."""

from typing import NamedTuple

import pandas as pd

from upswing.analysis import statistics, survival
from upswing.analysis.statistics import Estimate
from upswing.runs.files.typed_table import Columns
from upswing.runs.success import succeeds
from upswing.study.config import Study
from upswing.study.ids import cell_of

OF_AN_OUTCOME: Columns = {
    "swing_ups_last_fifth": "whole", "too_fast_last_fifth": "whole",
    "first_stable_step": "whole?", "diverged_at": "whole?",
}  # fmt: skip
"""What it is made from, besides whether a run succeeds."""


class Outcome(NamedTuple):
    """What the runs of a cell came to."""

    cell: str
    task: str
    succeed: int
    runs: int
    diverged: int
    share: Estimate  # of the runs that succeed
    stable: tuple[float, float, float]  # when half of the runs are stable, with its interval [s]
    too_fast: Estimate | None  # of arrivals in the last fifth, the share that nothing stops


def outcomes(table: pd.DataFrame, study: Study) -> list[Outcome]:
    """A row for each cell of a study that learns.

    Args:
        table: the table of runs.
        study: whose runs they are; adopted ones are left out.
    """
    cells = table["run"].map(cell_of)
    known = [
        (str(cell), runs) for cell, runs in table.groupby(cells, sort=False)
        if _learns(str(runs["task"].iloc[0]), str(runs["architecture"].iloc[0]), study)
    ]  # fmt: skip
    return [_outcome(cell, runs, study) for cell, runs in known]


def _learns(task: str, name: str, study: Study) -> bool:
    architecture = study.architectures.get(name)
    return task in study.tasks and architecture is not None and architecture.learns


def _outcome(cell: str, every: pd.DataFrame, study: Study) -> Outcome:
    task = study.tasks[str(every["task"].iloc[0])]
    runs = every[every["diverged_at"].isna()]
    number = int(succeeds(runs, task).sum())
    times = [None if pd.isna(step) else float(step) for step in runs["first_stable_step"]]
    second = float(task.pendulum.time_step)
    steps = survival.median_time(times, float(task.steps)) if times else (float("nan"),) * 3
    too_fast, arrivals = (
        runs[name].to_numpy(float) for name in ("too_fast_last_fifth", "swing_ups_last_fifth")
    )
    return Outcome(
        cell=cell,
        task=str(every["task"].iloc[0]),
        succeed=number,
        runs=len(runs),
        diverged=len(every) - len(runs),
        share=statistics.share(number, len(runs)),
        stable=(steps[0] * second, steps[1] * second, steps[2] * second),
        too_fast=statistics.ratio_of_sums(too_fast, arrivals)
        if task.judged_by == "upright" and arrivals.sum()
        else None,
    )
