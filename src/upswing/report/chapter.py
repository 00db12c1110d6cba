"""The chapter beyond the thesis: what its part of the page is given."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from upswing.analysis.beyond_tables import OF_A_CHANGE, OF_THE_CHOSEN, REMEDY
from upswing.optimal.tables import FULL_CONTROL, OF_THE_BOUND
from upswing.runs.files.typed_table import read_table
from upswing.study.paths import BEYOND, BOUND, CHANGES, CHOSEN

Row = dict[str, Any]


def chapter(results: Path, at: str = f"../{BEYOND}/report/") -> Row:
    """The chapter of a folder: its own, or that of the folder below it; empty where there is none.

    Its ``base`` is the way from the page to the chapter's own report: ``at``, or none for its own page.
    """
    for folder, base in ((results, ""), (results / BEYOND, at)):
        if all((folder / table).exists() for table in (CHANGES, BOUND)):
            return {
                "own": folder == results,
                "folder": folder,
                "base": base,
                "changes": _groups(read_table(folder / CHANGES, OF_A_CHANGE, REMEDY)),
                "bound": _bound(read_table(folder / BOUND, OF_THE_BOUND, REMEDY)),
                "optimal": _optimal(read_table(folder / BOUND, OF_THE_BOUND, REMEDY)),
                "chosen": _rows(read_table(folder / CHOSEN, OF_THE_CHOSEN, REMEDY))
                if (folder / CHOSEN).exists()
                else [],
            }
    return {"own": False, "folder": None}


def _rows(frame: pd.DataFrame) -> list[Row]:
    return [{str(name): value for name, value in row.items()} for row in frame.to_dict("records")]


def _groups(changes: pd.DataFrame) -> list[tuple[str, list[Row]]]:
    """The cells of each change, in order; experiments of the same title are one change."""
    return [
        (title, _rows(changes[changes["change"] == title]))
        for title in dict.fromkeys(changes["change"])
    ]


def _bound(bound: pd.DataFrame) -> Row:
    """Every number of the bound by its name: that of the finest grid, and how it came on coarser ones.

    ``tiles_`` and ``fastest_`` go before what belongs to those policies.
    """
    found: Row = {}
    steps: dict[str, list[float]] = {}
    for row in _rows(bound):
        if row["task"] != FULL_CONTROL or not np.isnan(row["discount"]):
            continue
        of = {"tiles": "tiles_", "fastest": "fastest_"}.get(str(row["policy"]), "")
        exact = "exact_" if row["grid"] == "exact" else ""
        found[f"{of}{exact}{row['quantity']}"] = row["value"]
        steps.setdefault(f"{of}{row['quantity']}", []).append(row["value"])
    return {**found, "refined": steps}


def _optimal(bound: pd.DataFrame) -> list[Row]:
    """For each γ, what the policy that is best for the discounted reward comes to on the finest grid."""
    optimal = bound[(bound["policy"] == "optimal") & bound["discount"].notna()]
    finest = optimal.drop_duplicates(["quantity", "discount"], keep="last")
    table = finest.pivot(index="discount", columns="quantity", values="value").reset_index()
    return _rows(table)
