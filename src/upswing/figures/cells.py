"""What the figures that sum up know of a cell: its label, and how many of its runs succeed."""

from typing import NamedTuple

import pandas as pd

from upswing import statistics
from upswing.figures.words import SUCCESS
from upswing.runs import Results


class Share(NamedTuple):
    """The share of a cell's runs that succeed, in per cent."""

    value: float
    low: float
    high: float
    successes: int
    of: int


def succeeds(runs: pd.DataFrame, kind: str) -> pd.Series:
    """Whether each run of a table balances in its last fifth, or is upright for 90 % of it."""
    if kind == "balancing":
        return runs["falls_last_fifth"] == 0
    return runs["upright_share"] >= SUCCESS


def share(results: Results, cell: str) -> Share:
    """How many runs of a cell succeed, with the 95 % interval of the share."""
    fulfilled = succeeds(results.cell(cell), results.kind(cell))
    successes, of = int(fulfilled.sum()), len(fulfilled)
    estimate = statistics.share(successes, of)
    return Share(100 * estimate.value, 100 * estimate.low, 100 * estimate.high, successes, of)


def label(cell: str) -> str:
    """A cell without its task: ``table, α = 0.75``."""
    _, architecture, alpha = cell.split("/")
    alpha = alpha.removeprefix("alpha-")
    return architecture if alpha == "none" else f"{architecture}, α = {alpha}"
