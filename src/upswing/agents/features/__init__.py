"""Feature encoders: what of a state (φ, φ̇) a learner is told (§3.3).

An encoder is a named tuple of numbers or tuples: hashable, no arrays. Its file gives a body to
``locate``, which answers with a place, and has a function ``create`` that makes one for a run; options
of its own, and what it gives a learner, stand there in a class ``Options``. One whose features are
numbers locates a state as a ``Point`` and gives a body to ``activate`` as well, which a learner asks for
them. Feature encoders are imported by name, as learners are.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from upswing.physics.jit import ByType
from upswing.physics.tasks import Task
from upswing.study.loading import load
from upswing.study.physical import TileOptions
from upswing.study.readings import Readings

Array = NDArray[np.float64]


class Place(NamedTuple):
    """A state as tiles: the module that owns it, and the tiles of that module that it lies in."""

    module: int
    tiles: tuple[int, ...]  # as many for every state of an encoder


class Point(NamedTuple):
    """A state as it is, for learners that need no tiles and for features that are numbers."""

    module: int
    angle: float  # φ [rad]
    angular_velocity: float  # φ̇ [rad/s]


class Picture(NamedTuple):
    """A grid of equal parts, at whose middles a picture of what was learned asks ``locate``."""

    angle_parts: int
    velocity_parts: int
    angle_limit: float  # the parts of φ cover ± this [rad]
    velocity_limit: float = 20.0  # the parts of φ̇ cover ± this [rad/s]


class Encoder(Protocol):
    """An encoder outside the loop."""

    def __hash__(self) -> int: ...

    @property
    def modules(self) -> int:
        """How many learners share the state space."""

    @property
    def tiles(self) -> int:
        """How many tiles, or features, a module has in all; 0 where states are told as they are."""

    @property
    def picture(self) -> Picture:
        """The parts of a picture of what was learned, whatever shape the tiles have."""


def _locate(encoder: Any, angle: float, angular_velocity: float) -> Any:
    """The place of φ [rad] and φ̇ [rad/s]."""
    raise TypeError(f"{type(encoder)} is no encoder")


_locate_by_type = ByType(_locate)
locate = _locate_by_type.call
locate_in = _locate_by_type.register


def _activate(encoder: Any, point: Point, features: Array) -> None:
    """Write into ``features``, (tiles,), how much each feature of the encoder answers to a state."""
    raise TypeError(f"{type(encoder)} has no features that are numbers")


_activate_by_type = ByType(_activate)
activate = _activate_by_type.call
activate_in = _activate_by_type.register


class Plan(NamedTuple):
    """What an encoder is made from."""

    task: Task
    options: Mapping[str, Any]  # of the architecture
    readings: Readings
    tiles: TileOptions = TileOptions()  # of the task, as in the configuration


def create(name: str, plan: Plan) -> Encoder:
    """An encoder, by the name of its file in this folder."""
    encoder: Encoder = load("features", name).create(plan)
    return encoder
