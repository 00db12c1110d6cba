"""All that dynamic programming says on one grid."""

from dataclasses import dataclass, field

import numpy as np

from upswing.optimal.min_time import Fastest, steps_to
from upswing.optimal.state_grid import Array, Grid, Successors, refined, successors
from upswing.optimal.value_iteration import Optimal, optimal_values
from upswing.optimal.viability import kept_shares
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL
from upswing.runs.metrics import UPRIGHT

THESIS = 0.7
"""γ in the thesis (§4.5.1)."""

FAR_SIGHTED = 0.99
"""γ of the policy that holds the pendulum after the fastest way up: 100 steps are half a second."""

DISCOUNTS = (THESIS, 0.8, 0.85, 0.9, 0.95, 0.97, FAR_SIGHTED, 0.995, 0.999)


@dataclass
class Solved:
    """A grid and what holds at its points; every array has shape (points,)."""

    body: Pendulum
    grid: Grid
    ways: Successors
    above: Array  # how much can be kept within ±90° forever
    upright: Array  # … within ±20°
    steps: Array  # to there [steps]
    optimal: dict[float, Optimal] = field(default_factory=dict)  # by γ

    @property
    def fastest(self) -> Fastest:
        """The fastest way to upright, and then the optimal policy of a large γ."""
        return Fastest(self.grid, self.steps, self.upright, self.optimal[FAR_SIGHTED])

    def begun(self, discount: float) -> Array | None:
        """Values to begin with: those of the nearest γ that is solved."""
        nearest = min(self.optimal, key=lambda solved: abs(solved - discount), default=None)
        return None if nearest is None else self.optimal[nearest].values

    def best(self, discount: float, begun: Array | None = None) -> Optimal:
        """The optimal policy for γ."""
        begun = self.begun(discount) if begun is None else begun
        return Optimal(self.grid, optimal_values(self.grid, self.ways, discount, begun), discount)


def solve(body: Pendulum, grid: Grid, coarser: Solved | None = None) -> Solved:
    """Everything for every γ of ``DISCOUNTS``; sooner if it can begin with a coarser grid."""
    ways = successors(body, grid)
    upright = kept_shares(grid, ways, UPRIGHT)
    solved = Solved(
        body,
        grid,
        ways,
        above=kept_shares(grid, ways, HORIZONTAL),
        upright=upright,
        steps=steps_to(grid, ways, upright),
    )
    for discount in DISCOUNTS:
        begun = refined(coarser.grid, coarser.optimal[discount].values, grid) if coarser else None
        solved.optimal[discount] = solved.best(discount, begun)
    return solved


def at_rest(grid: Grid, values: Array) -> Array:
    """Values at φ̇ = 0 for each φ of the grid, from hanging on: (rows,)."""
    middle: Array = values.reshape(grid.rows, grid.columns)[:, grid.columns // 2]
    return middle


def area(grid: Grid, values: Array) -> float:
    """The area where ``values`` ≥ ½ [rad²/s]."""
    each = 2 * np.pi / grid.rows * 2 * grid.limit / (grid.columns - 1)
    return float((values >= 0.5).sum() * each)
