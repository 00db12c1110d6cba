"""The bound → ``tables/bound.parquet``, and maps of its finest grid, ``tables/bound_maps.parquet``."""

from math import hypot, sqrt
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from upswing.optimal.body import body_of_study
from upswing.optimal.policies import act
from upswing.optimal.rows import Row, exact, explored_optimal, of_grid, thresholds
from upswing.optimal.solved import Solved, solve
from upswing.optimal.state_grid import Array, Grid, points
from upswing.optimal.tile_rows import of_tiles
from upswing.optimal.viability import HALF
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.study.config import Study
from upswing.study.paths import BOUND, MAPS

GRIDS = (Grid(180, 201), Grid(360, 401), Grid(720, 801))
"""Each twice as fine as the one before; −90°, ±20° and rest are among the points of all of them."""

PIXELS = 200
"""Largest number of points of a map along each axis."""


def write_bound(results: Path, study: Study | None = None) -> None:
    """Solve every grid (``GRIDS``), follow every policy, and write both tables below ``results``.

    The pendulum is that of the study's first task of full control, or the thesis's.
    """
    body = body_of_study(study)
    rows: list[Row] = [*exact(body)]
    solved: Solved | None = None
    for grid in grids_for(body):
        solved = solve(body, grid, solved)
        rows += [*of_grid(solved), *thresholds(solved)]
    assert solved is not None, "there are grids"  # noqa: S101
    rows += [*explored_optimal(solved), *of_tiles(solved)]
    write_table(results / BOUND, pd.DataFrame(rows).astype({"discount": "float64"}))
    write_table(results / MAPS, maps(solved))
    seal(results, "bound", [results / BOUND, results / MAPS])


def grids_for(body: Pendulum) -> list[Grid]:
    """The grids, reaching as far for this pendulum as they do for the thesis's."""
    reach = natural_speed(body) / natural_speed(Pendulum())
    return [grid._replace(limit=reach * grid.limit) for grid in GRIDS]


def natural_speed(body: Pendulum) -> float:
    """What velocities go with: √(√(g² + a²)/l) for the strongest push a [rad/s]."""
    push = max(map(abs, body.accelerations))
    return sqrt(hypot(body.gravity, push) / body.length)


def maps(solved: Solved) -> pd.DataFrame:
    """A row for each of some points of the grid, evenly spread.

    ``angle`` [rad], ``angular_velocity`` [rad/s], ``time_to_upright`` [s], ``keepable`` (above the
    horizontal), ``upright`` (within 20°), ``action_fastest``, and for each γ ``action_γ`` and
    ``value_γ`` [rad²], for example ``action_0.7``; actions are indices into the body's accelerations.
    """
    grid, body = solved.grid, solved.body
    row_step = -(-grid.rows // PIXELS)
    column_step = _step(grid.columns)
    index = np.arange(grid.rows * grid.columns).reshape(grid.rows, grid.columns)
    shown = index[::row_step, ::column_step].ravel()
    angles, velocities = (axis[shown] for axis in points(grid))
    columns: dict[str, NDArray[Any]] = {
        "angle": angles,
        "angular_velocity": velocities,
        "time_to_upright": solved.steps[shown] * body.time_step,
        "keepable": solved.above[shown] >= HALF,
        "upright": solved.upright[shown] >= HALF,
        "action_fastest": actions_at(solved.fastest, body, angles, velocities),
    }
    for discount, policy in solved.optimal.items():
        columns[f"action_{discount}"] = actions_at(policy, body, angles, velocities)
        columns[f"value_{discount}"] = policy.values[shown]
    return pd.DataFrame(columns)


def _step(columns: int) -> int:
    """Every which column is shown: both ends and the middle are."""
    half = (columns - 1) // 2
    return next(
        step for step in range(1, half + 1) if half % step == 0 and 2 * half // step < PIXELS
    )


def actions_at(policy: Any, body: Pendulum, angles: Array, velocities: Array) -> NDArray[np.int8]:
    """What a policy does in states [rad], [rad/s]; arrays of one length."""
    actions = np.zeros(len(angles), dtype=np.int8)
    _fill(policy, body, angles, velocities, actions)
    return actions


@compiled
def _fill(
    policy: Any, body: Pendulum, angles: Array, velocities: Array, actions: NDArray[np.int8]
) -> None:
    for point in range(len(angles)):
        actions[point] = act(policy, body, angles[point], velocities[point])
