"""The boxes of Barto, Sutton and Anderson (1983), which go back to Michie and Chambers (1968).

They cut the angle at 0, ±1, ±6 and ±12°, and the angular velocity at ±50 °/s. Two things differ here.
The cart's position and velocity, cut into 3 parts each there, are no part of the state: the track has no
end. And beyond ±12°, where a trial ends there, lies a box on either side for each part of the velocity.
"""

from math import degrees, pi
from typing import NamedTuple

from upswing.agents.features import Picture, Place, Plan, locate_in

ANGLES = (-12.0, -6.0, -1.0, 0.0, 1.0, 6.0, 12.0)
"""Where φ is cut [°]."""

VELOCITIES = (-50.0, 50.0)
"""Where φ̇ is cut [°/s]."""


class Boxes(NamedTuple):
    """The cuts, so that each box has one index."""

    angles: tuple[float, ...]  # [°]
    velocities: tuple[float, ...]  # [°/s]
    limit: float  # of pictures [rad]

    @property
    def modules(self) -> int:
        """One learner."""
        return 1

    @property
    def tiles(self) -> int:
        """How many boxes there are."""
        return (len(self.angles) + 1) * (len(self.velocities) + 1)

    @property
    def picture(self) -> Picture:
        """Parts of 1° around upright, where the boxes are small."""
        return Picture(60, 20, min(self.limit, pi / 6), 4.0)


@locate_in(Boxes)
def _locate(boxes: Boxes, angle: float, angular_velocity: float) -> Place:
    row = 0
    for cut in boxes.angles:
        row += int(degrees(angle) >= cut)
    column = 0
    for cut in boxes.velocities:
        column += int(degrees(angular_velocity) >= cut)
    return Place(0, (row * (len(boxes.velocities) + 1) + column,))


def create(plan: Plan) -> Boxes:
    """The boxes; the same for every task."""
    return Boxes(ANGLES, VELOCITIES, plan.task.largest_angle)
