"""When a run has succeeded: one meaning for the figures and the rule of selection."""

import pandas as pd

SUCCESS = 0.9
"""A run of full control succeeds if it is upright for this share of its last fifth."""


def succeeds(runs: pd.DataFrame, kind: str) -> pd.Series:
    """Whether each run of a ``kind`` of task does not fall in its last fifth, or is upright for most."""
    if kind == "balancing":
        return runs["falls_last_fifth"] == 0
    return runs["upright_share"] >= SUCCESS
