"""What goes beyond the thesis: what each change buys, and the shortest training."""

from math import isfinite

import pandas as pd

from upswing.cli.terminal import print_table


def print_changes(changes: pd.DataFrame) -> None:
    """Print a row for each cell of an experiment with a title."""
    rows = [
        (
            row["cell"],
            f"{row['sure']} of {row['runs']}",
            f"{row['upright']:.3f}",
            _steps(row["stable_step"]),
        )
        for row in changes.to_dict("records")
    ]
    header = ("cell", "reliable", "upright", "stable at step", "change")
    right = ("reliable", "upright", "stable at step")
    print_table(header, rows, right=right, words=[str(title) for title in changes["change"]])


def print_chosen(chosen: pd.DataFrame) -> None:
    """Print a row for each group of candidates: the one with the shortest reliable training."""
    rows = [
        (
            row["architecture"],
            f"{row['alpha']:g}",
            f"{row['discount']:g}",
            f"{row['sure']} of {row['seeds']}",
            _steps(row["steps"]),
        )
        for row in chosen.to_dict("records")
    ]
    header = ("architecture", "α", "γ", "reliable", "after steps", "candidates")
    right = ("reliable", "after steps")
    print_table(header, rows, right=right, words=[str(title) for title in chosen["title"]])


def _steps(steps: float) -> str:
    return f"{steps:,.0f}" if isfinite(steps) else "never"
