"""Binary tile coding of (φ, φ̇): every tile of a grid is one index (§3.3, §4.5, §4.6).

Modular learning (§4.6.3) is an encoder too: a fixed control structure answers which module owns a
state, and the tile inside that module.
"""

from math import floor, pi
from typing import NamedTuple

from pydantic import Field

from upswing.agents.features import Place, Plan, locate_in
from upswing.physics.jit import compiled
from upswing.physics.tasks import HORIZONTAL, Task
from upswing.study import architecture
from upswing.study.readings import Readings

VELOCITY_PARTS = 20
VELOCITY_LIMIT = 20.0
"""φ̇ is cut into 20 parts over ±20 rad/s; beyond it the edge tile serves (R15)."""

BALANCING_MODULE = 0
UPSWING_MODULE = 1


class Options(architecture.Architecture):
    """The grid may be shared by two modules."""

    modular: bool = Field(
        default=False, description="One learner above the horizontal and one below (§4.6.3)."
    )


class Tiles(NamedTuple):
    """A grid over (φ, φ̇), owned by one learner or by two modules."""

    angle_parts: int  # parts of φ over ± angle_limit
    angle_limit: float  # [rad]; beyond it the edge tile serves
    horizon: int  # parts of φ between upright and horizontal
    modular: bool

    @property
    def modules(self) -> int:
        """How many learners share the grid."""
        return 2 if self.modular else 1

    @property
    def tiles(self) -> int:
        """How many tiles one learner has."""
        return (self.angle_parts // self.modules) * VELOCITY_PARTS

    @property
    def picture(self) -> tuple[int, int, float]:
        """One pixel for each tile."""
        return self.angle_parts, VELOCITY_PARTS, self.angle_limit


def create(plan: Plan) -> Tiles:
    """The grid of the thesis."""
    return tiles_for(plan.task, bool(plan.options["modular"]), plan.readings)


def tiles_for(task: Task, modular: bool, readings: Readings) -> Tiles:
    """The grid of a task: 4 parts over ±π when balancing, 8 over ±2π for full control (§4.5.1, §4.6.1).

    The thesis's π is 90° under R2 `half_turn` and π rad under `radians`. Two modules share the grid
    of full control: each has half of its angles, 4 parts (§4.6.3).
    """
    half_turn = HORIZONTAL if readings.angle_unit == "half_turn" else pi
    whole_circle = modular or task.largest_angle > HORIZONTAL
    parts, limit = (8, 2 * half_turn) if whole_circle else (4, half_turn)
    return Tiles(parts, limit, round(HORIZONTAL / (2 * limit / parts)), modular)


@locate_in(Tiles)
def _locate(tiles: Tiles, angle: float, angular_velocity: float) -> Place:
    """A tile includes its lower edge, not its upper."""
    row = part(angle, tiles.angle_limit, tiles.angle_parts)
    column = part(angular_velocity, VELOCITY_LIMIT, VELOCITY_PARTS)
    if not tiles.modular:
        return Place(0, (row * VELOCITY_PARTS + column,))
    middle = tiles.angle_parts // 2
    quarter = tiles.angle_parts // 4
    if middle - tiles.horizon <= row < middle + tiles.horizon:
        return Place(BALANCING_MODULE, ((row - quarter) * VELOCITY_PARTS + column,))
    row = min(row, quarter - 1) if row < middle else max(row - middle, quarter)
    return Place(UPSWING_MODULE, (row * VELOCITY_PARTS + column,))


@compiled
def part(value: float, limit: float, parts: int) -> int:
    """Which of ``parts`` equal parts of ±``limit`` holds ``value``; the edge parts catch the rest."""
    index = floor((value + limit) / (2 * limit / parts))
    return int(min(max(index, 0), parts - 1))
