"""The verdicts on the claims."""

from collections import Counter
from typing import Any

import pandas as pd

from upswing.cli.terminal import print_table, say
from upswing.study.claim_parts import words_of

COLOURS = {
    "reproduced": "green",
    "holds": "green",
    "partly": "yellow",
    "at least partly": "yellow",
    "inconclusive": "magenta",
    "not reproduced": "red",
    "does not hold": "red",
    "not in this study": "bright_black",
}
HEADER = ("claim", "verdict", "estimate [95 %]", "threshold", "n", "what is claimed")


def _counted(rows: list[dict[str, Any]], own: bool) -> str:
    """How many of these have which verdict."""
    shown = Counter(words_of(row["verdict"], row["could_be_better"], own) for row in rows)
    return ", ".join(f"{shown[each]} {each}" for each in COLOURS if shown[each])


def print_verdicts(
    verdicts: pd.DataFrame, details: bool = False, judges: bool = True, own: bool = False
) -> None:
    """Print a row for each claim, below it what more is known of it, and how many have which verdict.

    Args:
        verdicts: the table.
        details: whether to say what is known of each.
        judges: whether the study says of itself that its runs are enough to judge by.
        own: whether the claims are the study's own and not the thesis's.
    """
    found = [{str(key): value for key, value in row.items()} for row in verdicts.to_dict("records")]
    print_table(
        HEADER,
        [_cells(row, own) for row in found],
        right=("n",),
        words=[row["statement"] for row in found],
        below=[_details(row) for row in found] if details else (),
        colours=COLOURS,
    )
    claims, checks = (
        [row for row in found if bool(row["check"]) == is_check] for is_check in (0, 1)
    )
    counts = "; ".join(
        f"{len(rows)} {what}{'' if len(rows) == 1 else 's'}: {_counted(rows, own)}"
        for what, rows in (("empirical claim", claims), ("check", checks))
        if rows
    )
    more = "" if details else "; --details says what was measured"
    say(f"{counts}{more}")
    if not judges:
        say(
            "nothing of this counts: the study has `judges: false`, its runs are too few or too short"
        )


def _cells(row: dict[str, Any], own: bool) -> tuple[str, ...]:
    estimate = f"{row['estimate']:.3g} [{row['low']:.3g}, {row['high']:.3g}]"
    return (
        row["claim"],
        words_of(row["verdict"], row["could_be_better"], own),
        estimate if row["n"] else "no runs",
        row["threshold"],
        str(row["n"]),
    )


def over_readings(row: dict[str, Any]) -> str:
    """How a claim does over readings, in a line; empty where they have not been asked."""
    if pd.isna(row["weighted_share"]):
        return ""
    low, high = row["weighted_low"], row["weighted_high"]
    return (
        f"{row['grade']}: {row['weighted_share']:.2f} [{low:.2f}, {high:.2f}] of their weight; more "
        f"likely than not under {row['held_share']:.0%} of them"
    )


def _details(row: dict[str, Any]) -> list[str]:
    """What is known of a claim beyond its row: each line is understood without the others."""
    parts = f", the weakest of {row['parts']} comparisons" if row["parts"] > 1 else ""
    lines = {
        "where it says so": row["section"],
        "measured": f"{row['measure']}{parts}",
        "cells": row["cells"],
        "interval": row["method"],
        "over readings": over_readings(row),
        "fragile": row["fragile_because"],
        "diverged, left out": str(row["diverged"]) if row["diverged"] else "",
        "note": row["note"],
    }
    return [f"{name}: {text}" for name, text in lines.items() if text]
