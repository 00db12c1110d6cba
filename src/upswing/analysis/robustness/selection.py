"""Which reading of the networks is the default: a rule fixed beforehand and charitable to the author.

The author used the same networks for figures 7, 9 and 11, so that one reading of R3 and R10–R12 has to
explain all three: the one under which what he reports is most likely,

    L = p₇ (1 − p₉) p₁₁ (1 − p₁₁),

on seeds that no verdict uses.
"""

import json

import pandas as pd

from upswing.runs.success import succeeds
from upswing.study.ids import CellId
from upswing.study.sweeps import CELLS_OF_SELECTION, SELECTION
from upswing.study.task import kind_of_task

SWEEP, CELLS = SELECTION, CELLS_OF_SELECTION


def select(runs: pd.DataFrame) -> pd.DataFrame:
    """The readings with their likelihood, the most likely first.

    Args:
        runs: the rows of the sweep: every reading's runs of the three cells.

    Returns:
        One row a reading: its options; of each cell how many runs succeed (``…_successes``), of how many
        (``runs``), and the share estimated as (k + 1) / (n + 2); ``likelihood``. Equal ones stay in the
        order of the grid.
    """
    rows = []
    for readings, of in runs.groupby("readings", sort=False):
        row = dict(json.loads(str(readings)))
        for name, cell in CELLS.items():
            own = succeeds(of[of["cell"] == cell], kind_of_task(CellId.parse(cell).task))
            row[f"{name}_successes"] = int(own.sum())
            row["runs"] = len(own)
            row[name] = (own.sum() + 1) / (len(own) + 2)
        row["likelihood"] = row["p7"] * (1 - row["p9"]) * row["p11"] * (1 - row["p11"])
        rows.append(row)
    frame = pd.DataFrame(rows)
    return frame.sort_values("likelihood", ascending=False, kind="stable", ignore_index=True)
