"""Binary tile coding of (φ, φ̇): every tile of a grid is one index (§3.3, §4.5, §4.6).

Modular learning (§4.6.3) is an encoder too: a fixed control structure answers which module owns a
state, and the tile inside that module.
"""

from math import floor, pi, radians
from typing import Any, NamedTuple

from pydantic import Field

from upswing.agents.features import Picture, Place, Plan, locate_in
from upswing.physics.jit import ByType, compiled
from upswing.physics.tasks import HORIZONTAL, Task
from upswing.study import architecture
from upswing.study import task as study_task
from upswing.study.physical import TileOptions
from upswing.study.readings import Readings

BALANCING_MODULE = 0
UPSWING_MODULE = 1


class Options(architecture.Architecture):
    """The grid may be shared by two modules."""

    modular: bool = Field(
        default=False, description="One learner above the horizontal and one below (§4.6.3)."
    )

    def check_with(self, task: study_task.Task) -> None:
        """Two modules share a whole turn, half of it each, on either side."""
        parts, limit = task.tiles.angle_parts, task.tiles.angle_limit
        if self.modular and (parts or 8) % 4:
            raise ValueError("with modules `angle_parts` is a multiple of 4")
        if self.modular and limit not in (None, 180):
            raise ValueError("with modules the tiles cover a whole turn; leave `angle_limit` out")


VELOCITY_PARTS = 20
VELOCITY_LIMIT = 20.0
"""The thesis cuts φ̇ into 20 parts over ±20 rad/s (§4.5.1)."""


class Columns(NamedTuple):
    """Equal parts of φ̇."""

    parts: int
    limit: float  # they cover ± this [rad/s]; beyond it the edge tile serves (R15)


class ThesisColumns(NamedTuple):
    """The parts of §4.5.1, known while the loop is compiled: a step of small networks takes 7 % less."""

    parts: int = VELOCITY_PARTS
    limit: float = VELOCITY_LIMIT


class Tiles(NamedTuple):
    """A grid over (φ, φ̇), owned by one learner or by two modules."""

    angle_parts: int  # parts of φ over ± angle_limit
    angle_limit: float  # [rad]; beyond it the edge tile serves
    columns: Columns | ThesisColumns
    horizon: int  # parts of φ between upright and horizontal
    modular: bool

    @property
    def velocity_parts(self) -> int:
        """How many parts φ̇ is cut into over ± ``velocity_limit``."""
        return self.columns.parts

    @property
    def velocity_limit(self) -> float:
        """The |φ̇| that the tiles cover [rad/s]."""
        return self.columns.limit

    @property
    def modules(self) -> int:
        """How many learners share the grid."""
        return 2 if self.modular else 1

    @property
    def tiles(self) -> int:
        """How many tiles one learner has."""
        return (self.angle_parts // self.modules) * self.velocity_parts

    @property
    def picture(self) -> Picture:
        """One pixel for each tile."""
        return Picture(self.angle_parts, self.velocity_parts, self.angle_limit, self.velocity_limit)


def create(plan: Plan) -> Tiles:
    """The grid of the thesis, or that of the configuration."""
    return tiles_of(plan, bool(plan.options["modular"]))


def tiles_of(plan: Plan, modular: bool = False) -> Tiles:
    """The grid of a run."""
    return tiles_for(plan.task, modular, plan.readings, plan.tiles)


def tiles_for(
    task: Task, modular: bool, readings: Readings, options: TileOptions | None = None
) -> Tiles:
    """The grid of a task: 4 parts over ±π when balancing, 8 over ±2π for full control (§4.5.1, §4.6.1).

    The thesis's π is 90° under R2 `half_turn` and π rad under `radians`. Two modules share the grid
    of full control: each has half of its angles, 4 parts (§4.6.3). ``options`` say what is otherwise.
    """
    options = options or TileOptions()
    half_turn = HORIZONTAL if readings.angle_unit == "half_turn" else pi
    whole_circle = modular or task.largest_angle > HORIZONTAL
    parts, limit = (8, 2 * half_turn) if whole_circle else (4, half_turn)
    parts = options.angle_parts or parts
    limit = limit if options.angle_limit is None else radians(options.angle_limit)
    columns = Columns(options.velocity_parts, float(options.velocity_limit))
    return Tiles(
        parts,
        limit,
        ThesisColumns() if tuple(columns) == ThesisColumns() else columns,
        horizon=round(HORIZONTAL / (2 * limit / parts)),
        modular=modular,
    )


def _tile(columns: Any, row: int, angular_velocity: float) -> int:
    """The tile of a row in which φ̇ [rad/s] lies."""
    parts: int = columns.parts
    return row * parts + part(angular_velocity, columns.limit, parts)


_tile_by_type = ByType(_tile)
tile = _tile_by_type.call


@_tile_by_type.register(ThesisColumns)
def _tile_of_thesis(_columns: ThesisColumns, row: int, angular_velocity: float) -> int:
    return row * VELOCITY_PARTS + part(angular_velocity, VELOCITY_LIMIT, VELOCITY_PARTS)


@locate_in(Tiles)
def _locate(tiles: Tiles, angle: float, angular_velocity: float) -> Place:
    """A tile includes its lower edge, not its upper."""
    row = part(angle, tiles.angle_limit, tiles.angle_parts)
    if not tiles.modular:
        return Place(0, (tile(tiles.columns, row, angular_velocity),))
    middle = tiles.angle_parts // 2
    quarter = tiles.angle_parts // 4
    if middle - tiles.horizon <= row < middle + tiles.horizon:
        row -= quarter
        return Place(BALANCING_MODULE, (tile(tiles.columns, row, angular_velocity),))
    row = min(row, quarter - 1) if row < middle else max(row - middle, quarter)
    return Place(UPSWING_MODULE, (tile(tiles.columns, row, angular_velocity),))


@compiled
def part(value: float, limit: float, parts: int) -> int:
    """Which of ``parts`` equal parts of ±``limit`` holds ``value``; the edge parts catch the rest."""
    index = floor((value + limit) / (2 * limit / parts))
    return int(min(max(index, 0), parts - 1))
