"""When a run, or a stretch of one, has succeeded: one meaning for tables, figures and policies."""

from typing import TYPE_CHECKING

from upswing.study.task import Task

if TYPE_CHECKING:
    import pandas as pd

SUCCESS = 0.9
"""Full control succeeds if the pendulum is upright for this share of what is judged: of a run's last
100,000 steps, of a policy's last steps from a start, of a stable window."""


def succeeds(runs: "pd.DataFrame", task: Task | type[Task]) -> "pd.Series":
    """Whether each run of a task does not fall in its last fifth, or stands at the end."""
    if task.judged_by == "falls":
        return runs["falls_last_fifth"] == 0
    return runs["upright_at_end"] >= SUCCESS
