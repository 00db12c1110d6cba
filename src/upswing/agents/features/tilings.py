"""Overlapping tilings: eight grids, each shifted by a part of a tile (Sutton and Barto 1998, §8.3.2).

A state lies in one tile of each, so what is learned about it spreads to its neighbourhood, and two
states that share all tiles of the thesis are told apart.
"""

from math import floor, pi
from typing import ClassVar, NamedTuple

import numpy as np

from upswing.agents.features import Picture, Place, Plan, locate_in
from upswing.agents.features.grid import tiles_of
from upswing.physics.jit import compiled
from upswing.study import architecture

TILINGS = 8
SHIFTS = (1, 3)
"""Number of eighths of a tile, of φ and of φ̇, by which each tiling is shifted from the one before."""


class Options(architecture.Architecture):
    """Tiles overlap."""

    gives: ClassVar[architecture.Features] = "tiles"


class Tilings(NamedTuple):
    """Grids over (φ, φ̇) with tiles of the thesis's size, one more of each kind to be shifted into."""

    angle_parts: int  # parts of φ over ± angle_limit, before the shift
    angle_limit: float  # [rad]
    velocity_parts: int  # parts of φ̇ over ± velocity_limit, before the shift
    velocity_limit: float  # [rad/s]
    round: bool  # whether φ comes round after ± angle_limit

    @property
    def modules(self) -> int:
        """One learner."""
        return 1

    @property
    def tiles(self) -> int:
        """Those of all tilings."""
        return TILINGS * (self.angle_parts + 1) * (self.velocity_parts + 1)

    @property
    def picture(self) -> Picture:
        """Fine enough to show where the tilings' borders are."""
        return Picture(
            8 * self.angle_parts, 4 * self.velocity_parts, self.angle_limit, self.velocity_limit
        )


@compiled
def tile_in(tilings: Tilings, tiling: int, angle: float, angular_velocity: float) -> int:
    """The tile of one tiling that holds a state; what lies outside is counted to the edge."""
    parts = tilings.angle_parts
    across = (angle + tilings.angle_limit) / (2 * tilings.angle_limit) * parts
    if angle < tilings.angle_limit:
        # Just below the limit the quotient may round up to the limit itself.
        across = min(across, np.nextafter(float(parts), 0.0))
    limit, velocity_parts = tilings.velocity_limit, tilings.velocity_parts
    up = (angular_velocity + limit) / (2 * limit) * velocity_parts
    shift_across = (SHIFTS[0] * tiling) % TILINGS / TILINGS
    shift_up = (SHIFTS[1] * tiling) % TILINGS / TILINGS
    row = floor(across + shift_across)
    # On a whole circle the last part continues in the first.
    row = row % parts if tilings.round else min(max(row, 0), parts)
    column = min(max(floor(up + shift_up), 0), velocity_parts)
    return int((tiling * (parts + 1) + row) * (velocity_parts + 1) + column)


@locate_in(Tilings)
def _locate(tilings: Tilings, angle: float, angular_velocity: float) -> Place:
    return Place(
        0,
        (
            tile_in(tilings, 0, angle, angular_velocity),
            tile_in(tilings, 1, angle, angular_velocity),
            tile_in(tilings, 2, angle, angular_velocity),
            tile_in(tilings, 3, angle, angular_velocity),
            tile_in(tilings, 4, angle, angular_velocity),
            tile_in(tilings, 5, angle, angular_velocity),
            tile_in(tilings, 6, angle, angular_velocity),
            tile_in(tilings, 7, angle, angular_velocity),
        ),
    )


def create(plan: Plan) -> Tilings:
    """Tilings of the task's own grid."""
    grid = tiles_of(plan)
    comes_round = plan.task.wraps and grid.angle_limit == pi
    return Tilings(
        grid.angle_parts, grid.angle_limit, grid.velocity_parts, grid.velocity_limit, comes_round
    )
