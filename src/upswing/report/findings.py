"""The three findings of the first screen, each asked of the tables: what is not so there is not said."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import pandas as pd

from upswing.analysis import statistics
from upswing.study.names import alpha_text

Row = dict[str, Any]
Cells = Mapping[str, Row]
"""The rows of the table of cells by their ids."""

FIGURE_8 = "full-control/table/alpha-0.001"
LARGE, SMALL = "balancing/table/alpha-1", "balancing/table/alpha-0.001"
DEPENDS = "depends on the reading"


class Finding(NamedTuple):
    """What was found, how sure it is, and where it is shown."""

    number: str
    says: str
    certainty: str
    claim: str


def findings(cells: Cells, verdicts: list[Row]) -> list[Finding]:
    """Those of the three findings that hold in this study."""
    return [
        *_tables_learn(cells, verdicts),
        *_networks_depend(verdicts),
        *_small_steps_are_stable(cells, verdicts),
    ]


def learned(cells: Cells) -> tuple[Row, Row] | None:
    """The table that learns full control best, and that of figure 8; None where it does no better.

    It learns if most of its runs stand at the end, and surely more than those of figure 8.
    """
    own = [row for cell, row in cells.items() if cell.startswith("full-control/table/")]
    if FIGURE_8 not in cells or len(own) < 2:
        return None
    best = max(own, key=lambda row: row["runs_upright_at_end"] / max(row["runs"], 1))
    thesis = cells[FIGURE_8]
    gained = statistics.difference_of_shares(_standing(best), _standing(thesis))
    most = 2 * best["runs_upright_at_end"] > best["runs"]
    return (best, thesis) if gained.n and gained.low > 0 and most else None


def _standing(row: Row) -> tuple[int, int]:
    return row["runs_upright_at_end"], row["runs"]


def _tables_learn(cells: Cells, verdicts: list[Row]) -> Iterator[Finding]:
    """A table learns full control, with another α than that of figure 8."""
    if (found := learned(cells)) is None:
        return
    best, thesis = found
    yield Finding(
        "{} of {}".format(*_standing(best)),
        "tables learn to swing up and to stand, with the step size "
        f"α = {alpha_text(best['alpha'])}. With α = {alpha_text(thesis['alpha'])}, as in the thesis’s "
        "figure 8, {} of {} do in the same time. What fails there is the step size, ".format(
            *_standing(thesis)
        )
        + "not the table.",
        f"{_surely(_standing(best))}{_over_readings(verdicts, 'C8')}",
        "C8",
    )


def _networks_depend(verdicts: list[Row]) -> Iterator[Finding]:
    """What networks do hangs on what the thesis does not say."""
    asked = [
        row for row in verdicts if "networks" in row["cells"] and not pd.isna(row["weighted_share"])
    ]
    depend = [row for row in asked if row["grade"] == DEPENDS]
    if depend:
        yield Finding(
            f"{len(depend)} of {len(asked)}",
            "claims about networks depend on what the thesis does not say, above all on the rate η of "
            "backpropagation. They hold under some readings and fail under others.",
            "Probabilities over readings: "
            + ", ".join(f"{row['claim']} {row['weighted_share']:.2f}" for row in depend),
            str(depend[0]["claim"]),
        )


def _small_steps_are_stable(cells: Cells, verdicts: list[Row]) -> Iterator[Finding]:
    """Balancing is stable with small steps, and with α = 1 it is not."""
    if not {LARGE, SMALL} <= cells.keys():
        return
    shares = [
        (cells[cell]["runs_without_fall_in_last_fifth"], cells[cell]["runs"])
        for cell in (SMALL, LARGE)
    ]
    gained = statistics.difference_of_shares(shares[0], shares[1])
    if gained.n and gained.low > 0.5:
        yield Finding(
            f"{shares[0][0]} of {shares[0][1]}",
            "tables balance to the end with the step size α = 0.001. With α = 1, "
            f"{shares[1][0]} of {shares[1][1]} do. Small steps make control stable, as the thesis says.",
            f"{_surely(shares[0])}{_over_readings(verdicts, 'C3')}",
            "C3",
        )


def _surely(share: tuple[int, int]) -> str:
    found = statistics.share(*share)
    return f"95 % interval of this share: {found.low:.2f} to {found.high:.2f}"


def _over_readings(verdicts: list[Row], claim: str) -> str:
    """How probable the claim is over readings, where that is known."""
    for row in verdicts:
        if row["claim"] == claim and not pd.isna(row["weighted_share"]):
            share = f"{row['weighted_share']:.2f}"
            return f". The thesis’s {claim} holds with probability {share} over readings"
    return ""
