"""Can a table represent full control at all? ``tables/tiles.parquet``: a policy on its tiles, followed.

C9 says that a table cannot. One policy on the thesis's own 160 tiles that does the task refutes it,
however it was found: here by changing at random what a table had learned (``tile_search``). So this is a
lower bound of what tables can represent, and of what they learn it says nothing.
"""

from pathlib import Path

import numpy as np
import pandas as pd

from upswing.optimal.follow import without_exploring
from upswing.optimal.tile_policy import Actions, TilePolicy, thesis_tiles
from upswing.optimal.tile_search import learned, search
from upswing.physics.pendulum import Pendulum
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.runs.metrics import UPRIGHT
from upswing.runs.success import SUCCESS
from upswing.study.paths import TILES
from upswing.study.task import kind_of_task

KIND = "full-control"
ALPHA, STEPS = 0.01, 1_000_000
"""What the table had learned by, that the search begins with."""

SEED = 1000
"""That of the table and of the search: one that no verdict uses."""

BUDGET = 100
"""Largest number of changes that the search tries."""


def write_represented(results: Path) -> pd.DataFrame:
    """Search, follow what was found from every start, and write the table; returns it."""
    body = Pendulum()
    found = search(KIND, body, learned(KIND, ALPHA, SEED, STEPS), SEED, BUDGET)
    table = followed(found.actions, body)
    write_table(results / TILES, table)
    seal(results, "tiles", [results / TILES])
    return table


def followed(actions: Actions, body: Pendulum) -> pd.DataFrame:
    """A row for each start of the study's greedy evaluation, without exploring.

    Columns ``angle`` [rad], ``upright_share`` (of the judged steps) and ``success``.
    """
    task, policy = kind_of_task(KIND), TilePolicy(thesis_tiles(KIND), actions)
    rows = []
    for start in task.greedy_starts:
        angles = without_exploring(policy, body, start, 0.0, task.greedy_steps)
        share = float((np.abs(angles[-task.greedy_judged - 1 : -1]) <= UPRIGHT).mean())
        rows.append({"angle": start, "upright_share": share, "success": share >= SUCCESS})
    return pd.DataFrame(rows)
