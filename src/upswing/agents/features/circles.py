"""Coarse coding by overlapping circles (§3.1.5; Sutton and Barto 1998, §8.3.1).

A circle lies around the middle of every tile of the grid. Its feature is 1 if the state lies in it, else
0. In both directions distance is counted in tiles, so in rad and rad/s the circles are ellipses.
"""

from typing import Annotated, ClassVar, NamedTuple

from pydantic import Field

from upswing.agents.features import Array, Picture, Plan, Point, activate_in, locate_in
from upswing.agents.features.radial import Centres, angle_away, centres_of, velocity_away
from upswing.study import architecture


class Options(architecture.Architecture):
    """How large they are."""

    gives: ClassVar[architecture.Features] = "activations"
    radius: Annotated[float, Field(ge=0.75, le=10)] = Field(
        default=1.5,
        description="Radius of the circles, as a multiple of the distance between two centres; below "
        "0.71 some states would lie in none.",
    )


class Circles(NamedTuple):
    """Circles of one size around centres."""

    centres: Centres
    radius: float  # in distances between centres

    @property
    def modules(self) -> int:
        """One learner."""
        return 1

    @property
    def tiles(self) -> int:
        """One feature for every circle."""
        return self.centres.number

    @property
    def picture(self) -> Picture:
        """That of the centres."""
        return self.centres.picture


@locate_in(Circles)
def _locate(_circles: Circles, angle: float, angular_velocity: float) -> Point:
    return Point(0, angle, angular_velocity)


@activate_in(Circles)
def _activate(circles: Circles, point: Point, features: Array) -> None:
    centres, most = circles.centres, circles.radius * circles.radius
    columns = centres.velocity_parts
    for row in range(centres.angle_parts):
        across = angle_away(centres, row, point.angle)
        for column in range(columns):
            up = velocity_away(centres, column, point.angular_velocity)
            inside = across * across + up * up < most
            features[row * columns + column] = 1.0 if inside else 0.0


def create(plan: Plan) -> Circles:
    """A circle around the middle of every tile of the task."""
    return Circles(centres_of(plan), float(plan.options["radius"]))
