"""When a run, or a stretch of one, has succeeded: one meaning for tables, figures and policies."""

import pandas as pd

SUCCESS = 0.9
"""Full control succeeds if the pendulum is upright for this share of what is judged: of a run's last
fifth, of a policy's last steps from a start, of a stable window."""


def succeeds(runs: pd.DataFrame, kind: str) -> pd.Series:
    """Whether each run of a ``kind`` of task does not fall in its last fifth, or is upright for most."""
    if kind == "balancing":
        return runs["falls_last_fifth"] == 0
    return runs["upright_share"] >= SUCCESS
