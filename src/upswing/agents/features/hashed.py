"""Hashed tiles: many fine ones, scattered over few entries (§3.3; Sutton and Barto 1998, p. 207)."""

from typing import Annotated, NamedTuple

from pydantic import Field

from upswing.agents.features import Picture, Place, Plan, fine, locate_in
from upswing.agents.features.fine import Fine
from upswing.agents.features.grid import part
from upswing.study import architecture


class Options(architecture.Architecture):
    """How fine, and over how many entries."""

    cuts: Annotated[int, Field(ge=2, le=32)] = Field(
        description="Each tile of the thesis is cut into cuts × cuts."
    )
    entries: Annotated[int, Field(ge=1, le=1_000_000)] = Field(
        description="Number of entries that the tiles are scattered over."
    )


class Hashed(NamedTuple):
    """A fine grid whose tiles share entries, without regard to where they lie."""

    grid: Fine
    entries: int

    @property
    def modules(self) -> int:
        """One learner."""
        return 1

    @property
    def tiles(self) -> int:
        """As many as there are entries."""
        return self.entries

    @property
    def picture(self) -> Picture:
        """One pixel for each tile of the fine grid."""
        return self.grid.picture


@locate_in(Hashed)
def _locate(hashed: Hashed, angle: float, angular_velocity: float) -> Place:
    grid = hashed.grid
    row = part(angle, grid.angle_limit, grid.angle_parts)
    column = part(angular_velocity, grid.velocity_limit, grid.velocity_parts)
    # Multiplication by an odd number near 2³²/φ scatters neighbours (Knuth, TAOCP 3, §6.4).
    scattered = ((row * grid.velocity_parts + column) * 2654435761) & 0xFFFFFFFF
    return Place(0, (((scattered >> 8) % hashed.entries),))


def create(plan: Plan) -> Hashed:
    """The tiles of ``fine``, scattered over ``entries``."""
    return Hashed(fine.create(plan), plan.options["entries"])
