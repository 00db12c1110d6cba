"""Cells with the same runs, bit for bit, shown once: two tables of 4 × 20 tiles are one of 8 × 20."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    import pandas as pd

Cell = TypeVar("Cell")
Runs = frozenset[tuple[int, str]]
"""Seed and digest of each."""


def runs_of(rows: "pd.DataFrame") -> Runs:
    """What tells the runs of a cell apart, from their rows of the table of runs."""
    return frozenset(zip(rows["seed"], rows["digest"], strict=True))


def once(runs: Mapping[Cell, Runs]) -> dict[Cell, list[Cell]]:
    """Each cell that is shown, and the others whose every run it has as well.

    Of cells with the same runs the one with more seeds is shown, else the first.
    """
    shown: dict[Cell, list[Cell]] = {}
    for cell in sorted(runs, key=lambda cell: -len(runs[cell])):
        whole = next((other for other in shown if runs[cell] <= runs[other]), None)
        if whole is None:
            shown[cell] = []
        else:
            shown[whole].append(cell)
    return {cell: shown[cell] for cell in runs if cell in shown}
