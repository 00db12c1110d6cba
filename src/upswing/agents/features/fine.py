"""The grid of the thesis, every tile of it cut into finer ones (C9: is it too coarse?)."""

from typing import Annotated, NamedTuple

from pydantic import Field

from upswing.agents.features import Picture, Place, Plan, locate_in
from upswing.agents.features.grid import part, tiles_of
from upswing.study import architecture


class Options(architecture.Architecture):
    """How fine."""

    cuts: Annotated[int, Field(ge=2, le=32)] = Field(
        description="Each tile of the thesis is cut into cuts × cuts."
    )


class Fine(NamedTuple):
    """A grid over (φ, φ̇)."""

    angle_parts: int  # parts of φ over ± angle_limit
    angle_limit: float  # [rad]
    velocity_parts: int  # parts of φ̇ over ± velocity_limit
    velocity_limit: float  # [rad/s]

    @property
    def modules(self) -> int:
        """One learner."""
        return 1

    @property
    def tiles(self) -> int:
        """How many tiles there are."""
        return self.angle_parts * self.velocity_parts

    @property
    def picture(self) -> Picture:
        """One pixel for each tile."""
        return Picture(self.angle_parts, self.velocity_parts, self.angle_limit, self.velocity_limit)


@locate_in(Fine)
def _locate(fine: Fine, angle: float, angular_velocity: float) -> Place:
    row = part(angle, fine.angle_limit, fine.angle_parts)
    column = part(angular_velocity, fine.velocity_limit, fine.velocity_parts)
    return Place(0, (row * fine.velocity_parts + column,))


def create(plan: Plan) -> Fine:
    """The thesis's grid for the kind of task, each tile cut into ``cuts`` × ``cuts``."""
    coarse, cuts = tiles_of(plan), plan.options["cuts"]
    return Fine(
        coarse.angle_parts * cuts, coarse.angle_limit, coarse.velocity_parts * cuts,
        coarse.velocity_limit,
    )  # fmt: skip
