"""Gaussian radial basis functions: a bell around the middle of every tile of the grid (§3.1.5).

Each bell answers to a state by how near it is: 1 in its centre and exp(−d² / 2σ²) at a distance d. In
both directions distance is counted in tiles, from one centre to the next.
"""

from math import pi
from typing import ClassVar, NamedTuple

from pydantic import Field

from upswing.agents.features import Array, Picture, Plan, Point, activate_in, locate_in
from upswing.agents.features.grid import tiles_of
from upswing.physics.elementary import exp_of_negative
from upswing.physics.jit import inlined
from upswing.study import architecture
from upswing.study.values import Positive


class Options(architecture.Architecture):
    """How wide they are."""

    gives: ClassVar[architecture.Features] = "activations"
    width: Positive = Field(
        default=1.0,
        description="σ of the Gaussian features, as a multiple of the distance between two centres.",
    )


class Centres(NamedTuple):
    """The middles of the tiles of a grid over (φ, φ̇), one row of equal φ after the other."""

    angle_parts: int  # parts of φ over ± angle_limit
    angle_limit: float  # [rad]
    velocity_parts: int  # parts of φ̇ over ± velocity_limit
    velocity_limit: float  # [rad/s]
    round: bool  # whether φ comes round after ± angle_limit

    @property
    def number(self) -> int:
        """How many centres there are."""
        return self.angle_parts * self.velocity_parts

    @property
    def picture(self) -> Picture:
        """Fine enough to show what lies between two centres."""
        return Picture(
            4 * self.angle_parts, 2 * self.velocity_parts, self.angle_limit, self.velocity_limit
        )


def centres_of(plan: Plan) -> Centres:
    """The middles of the tiles of a run."""
    grid = tiles_of(plan)
    comes_round = plan.task.wraps and grid.angle_limit == pi
    return Centres(
        grid.angle_parts, grid.angle_limit, grid.velocity_parts, grid.velocity_limit, comes_round
    )


@inlined
def angle_away(centres: Centres, row: int, angle: float) -> float:
    """How many parts of φ lie between ``angle`` [rad] and a row of centres; the shorter way round."""
    parts, limit = centres.angle_parts, centres.angle_limit
    if not centres.round:  # what lies outside is counted to the edge
        angle = min(max(angle, -limit), limit)
    away = abs((angle + limit) / (2 * limit) * parts - row - 0.5)
    return min(away, parts - away) if centres.round else away


@inlined
def velocity_away(centres: Centres, column: int, angular_velocity: float) -> float:
    """How many parts of φ̇ lie between ``angular_velocity`` [rad/s] and a column of centres."""
    limit = centres.velocity_limit
    inside = min(max(angular_velocity, -limit), limit)
    return abs((inside + limit) / (2 * limit) * centres.velocity_parts - column - 0.5)


class Radial(NamedTuple):
    """Bells of one width around centres."""

    centres: Centres
    width: float  # σ, in distances between centres

    @property
    def modules(self) -> int:
        """One learner."""
        return 1

    @property
    def tiles(self) -> int:
        """One feature for every centre."""
        return self.centres.number

    @property
    def picture(self) -> Picture:
        """That of the centres."""
        return self.centres.picture


@locate_in(Radial)
def _locate(_radial: Radial, angle: float, angular_velocity: float) -> Point:
    return Point(0, angle, angular_velocity)


@activate_in(Radial)
def _activate(radial: Radial, point: Point, features: Array) -> None:
    centres = radial.centres
    columns, scale = centres.velocity_parts, -0.5 / (radial.width * radial.width)
    # A bell is the product of one over φ and one over φ̇. Those over φ̇ wait in the first row, which is
    # made last.
    for column in range(columns):
        away = velocity_away(centres, column, point.angular_velocity)
        features[column] = exp_of_negative(scale * away * away)
    for back in range(centres.angle_parts):
        row = centres.angle_parts - 1 - back
        away = angle_away(centres, row, point.angle)
        bell = exp_of_negative(scale * away * away)
        for column in range(columns):
            features[row * columns + column] = bell * features[column]


def create(plan: Plan) -> Radial:
    """A bell in the middle of every tile of the task."""
    return Radial(centres_of(plan), float(plan.options["width"]))
