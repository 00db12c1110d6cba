"""The chapter beyond the thesis: what its part of the page is given."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from upswing.analysis.beyond_tables import OF_A_CHANGE, OF_THE_CHOSEN, REMEDY
from upswing.optimal.tables import FULL_CONTROL, OF_THE_BOUND
from upswing.report.judged import judged
from upswing.runs.files.tables import read_evidence
from upswing.runs.files.typed_table import read_table
from upswing.runs.study_file import read_study
from upswing.study.ids import cell_of, run_of
from upswing.study.paths import BEYOND, BOUND, CHANGES, CHOSEN, VERDICTS

Row = dict[str, Any]


NOTHING: Row = {"own": False, "folder": None}
"""What there is of a chapter where none was run."""


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
                "changes": changes(folder),
                "bound": _bound(read_table(folder / BOUND, OF_THE_BOUND, REMEDY)),
                "optimal": _optimal(read_table(folder / BOUND, OF_THE_BOUND, REMEDY)),
                "chosen": _rows(read_table(folder / CHOSEN, OF_THE_CHOSEN, REMEDY))
                if (folder / CHOSEN).exists()
                else [],
            }
    return NOTHING


def _rows(frame: pd.DataFrame) -> list[Row]:
    return [{str(name): value for name, value in row.items()} for row in frame.to_dict("records")]


def changes(folder: Path) -> list[Row]:
    """Each change: its title, where it comes from, its cells in order, and what was expected of it.

    Experiments of the same title are one change. A claim of the study's own belongs to the change whose
    cell it shows in recordings.
    """
    study = read_study(folder)
    table = read_table(folder / CHANGES, OF_A_CHANGE, REMEDY)
    judges = bool(study.claims) and study.judges and (folder / VERDICTS).exists()
    claims = judged(folder, read_evidence(folder), own=True) if judges else []
    found = []
    for title in dict.fromkeys(table["change"]):
        cells = _rows(table[table["change"] == title])
        names = {row["cell"] for row in cells}
        found.append(
            {
                "title": title,
                "source": next(
                    (one.source for one in study.experiments if one.title == title and one.source),
                    "",
                ),
                "cells": cells,
                "expected": [claim for claim in claims if _cell_shown(claim) in names],
            }
        )
    return found


def _cell_shown(claim: Row) -> str:
    """The cell of a claim's recordings; empty where it has none."""
    return cell_of(run_of(claim["recordings"][0])) if len(claim["recordings"]) else ""


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
