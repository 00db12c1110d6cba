"""How V and the policy settle, sweep by sweep (§2.4.1) → ``tables/settling.parquet``."""

from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd

from upswing.optimal.body import reaching
from upswing.optimal.policy_iteration import Actions, Moment, improved, policy_iteration
from upswing.optimal.state_grid import Array, Grid, Successors, successors
from upswing.optimal.value_iteration import optimal_values
from upswing.physics.pendulum import Pendulum
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.study.paths import SETTLING

GRID = Grid(180, 201)
"""As coarse as the coarsest grid of the bound, and reaching as far."""

DISCOUNTS = (0.7, 0.97)
"""The thesis's γ (§4.5.1), and one whose best policy swings up."""

PATIENCE = 10
"""Number of sweeps of an evaluation that is not waited for."""

VALUE_ITERATION = "value iteration"
GENERALIZED = f"{PATIENCE} sweeps, then an improvement"
POLICY_ITERATION = "policy iteration"
METHODS = (VALUE_ITERATION, GENERALIZED, POLICY_ITERATION)

SPARSER = 1.05
"""A row is kept once this many times the backups of the one before were made (even on a log scale), and
the last one, which says how many were needed."""


class Row(NamedTuple):
    """How far a method has come after a sweep."""

    method: str  # of ``METHODS``
    discount: float  # γ
    backups: int  # values of (s, a) computed so far, in sweeps over all points
    improvements: int  # how often the policy was made greedy before
    error: float  # the largest |V − V*| of a point [rad²]
    worse: float  # share of points in which the policy's action is not one of the best


class Watched:
    """Rows of one method and γ, while it is at work."""

    def __init__(self, grid: Grid, ways: Successors, discount: float) -> None:
        self.grid, self.ways, self.discount = grid, ways, discount
        self.best = optimal_values(grid, ways, discount)
        self.rows: list[Row] = []

    def see(self, method: str, moment: Moment) -> None:
        """Keep what is to be seen of a moment; of very near ones in a row the last alone."""
        own = [row for row in self.rows if row.method == method]
        if len(own) > 1 and own[-1].backups < SPARSER * own[-2].backups:
            self.rows.remove(own[-1])
        error = float(np.abs(moment.values - self.best).max())
        worse = self._worse(moment.policy)
        self.rows.append(
            Row(method, self.discount, moment.backups, moment.improvements, error, worse)
        )

    def greedy(self, values: Array) -> Actions:
        """The policy that is greedy for ``values``."""
        policy = np.zeros(len(values), np.int8)
        improved(self.grid, self.ways, self.discount, values, policy)
        return policy

    def _worse(self, policy: Actions) -> float:
        """The share of points where an improvement by V* would change the policy."""
        return improved(self.grid, self.ways, self.discount, self.best, policy.copy()) / len(policy)


def settle(body: Pendulum, grid: Grid, discount: float) -> list[Row]:
    """Let every method find the best policy, and watch it."""
    ways = successors(body, grid)
    watched, actions = Watched(grid, ways, discount), ways.corner.shape[1]
    sweeps = 0

    def swept(values: Array) -> None:
        nonlocal sweeps
        sweeps += 1
        moment = Moment(sweeps, values, watched.greedy(values), sweeps * actions)
        watched.see(VALUE_ITERATION, moment)

    optimal_values(grid, ways, discount, swept=swept)
    for method, patience in ((GENERALIZED, PATIENCE), (POLICY_ITERATION, None)):
        policy_iteration(
            grid, ways, discount, patience,
            watch=lambda moment, method=method: watched.see(method, moment),  # type: ignore[misc]
        )  # fmt: skip
    return watched.rows


def write_settling(results: Path, body: Pendulum | None = None) -> None:
    """Watch every method with every γ, and write the table."""
    body = body or Pendulum()
    grid = reaching(GRID, body)
    rows = [row for discount in DISCOUNTS for row in settle(body, grid, discount)]
    write_table(results / SETTLING, pd.DataFrame(rows))
    seal(results, "settling", [results / SETTLING])
