"""The state itself, without tiles: sine and cosine of φ, and φ̇ (§3.3 asks what else there is)."""

from typing import ClassVar, NamedTuple

from upswing.agents.features import Picture, Plan, Point, locate_in
from upswing.agents.features.grid import tiles_of
from upswing.study import architecture

PICTURE = (40, 40)
"""Parts of φ and of φ̇ of a picture of what was learned."""


class Options(architecture.Architecture):
    """There are no tiles."""

    gives: ClassVar[architecture.Features] = "state"


class Continuous(NamedTuple):
    """States as they are."""

    angle_limit: float  # of pictures [rad]
    velocity_limit: float  # … [rad/s]

    @property
    def modules(self) -> int:
        """One learner."""
        return 1

    @property
    def tiles(self) -> int:
        """There are none."""
        return 0

    @property
    def picture(self) -> Picture:
        """A grid fine enough to show what a network draws."""
        return Picture(*PICTURE, self.angle_limit, self.velocity_limit)


@locate_in(Continuous)
def _locate(continuous: Continuous, angle: float, angular_velocity: float) -> Point:
    return Point(0, angle, angular_velocity)


def create(plan: Plan) -> Continuous:
    """States of the task."""
    grid = tiles_of(plan)
    return Continuous(grid.angle_limit, grid.velocity_limit)
