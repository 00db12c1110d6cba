"""The grid of the thesis, every tile of it cut into finer ones (C9: is it too coarse?)."""

from typing import Annotated, NamedTuple

from pydantic import Field

from upswing.agents.features import Place, Plan, locate_in
from upswing.agents.features.grid import VELOCITY_LIMIT, VELOCITY_PARTS, part, tiles_for
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
    velocity_parts: int  # parts of φ̇ over ± VELOCITY_LIMIT

    @property
    def modules(self) -> int:
        """One learner."""
        return 1

    @property
    def tiles(self) -> int:
        """How many tiles there are."""
        return self.angle_parts * self.velocity_parts

    @property
    def picture(self) -> tuple[int, int, float]:
        """One pixel for each tile."""
        return self.angle_parts, self.velocity_parts, self.angle_limit


@locate_in(Fine)
def _locate(fine: Fine, angle: float, angular_velocity: float) -> Place:
    row = part(angle, fine.angle_limit, fine.angle_parts)
    column = part(angular_velocity, VELOCITY_LIMIT, fine.velocity_parts)
    return Place(0, (row * fine.velocity_parts + column,))


def create(plan: Plan) -> Fine:
    """The thesis's grid for the kind of task, each tile cut into ``cuts`` × ``cuts``."""
    coarse, cuts = tiles_for(plan.task, False, plan.readings), plan.options["cuts"]
    return Fine(coarse.angle_parts * cuts, coarse.angle_limit, VELOCITY_PARTS * cuts)
