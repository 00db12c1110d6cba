"""Two modules and a control structure that is itself a learner (§3.4, last paragraph).

Each module is a whole learner of its own, a table or networks. For every tile the control structure
knows what each module has been worth there, hands the state to the better one, takes the action it
proposes, and gives it the reward; so it learns which states belong to which module. It begins with
zero for both, which is optimistic, and so tries both everywhere.
"""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from upswing.agents.features import Place
from upswing.agents.learners import Array, Beginning, Learner, update, update_of, values, values_of
from upswing.agents.policy import Q
from upswing.physics.jit import inlined
from upswing.study import architecture
from upswing.study.loading import load
from upswing.study.values import LayerSizes


class Options(architecture.Architecture):
    """What the two modules are."""

    takes: ClassVar[tuple[architecture.Features, ...]] = ("tile",)
    hidden: LayerSizes = Field(
        default=(), description="Numbers of units of the modules' hidden layers; none for tables."
    )

    @staticmethod
    def module(hidden: tuple[int, ...]) -> str:
        """The learner that each module is, by name."""
        return "networks" if hidden else "table"

    def inner_learners(self) -> tuple[str, ...]:
        """The learner of the modules."""
        return (type(self).module(self.hidden),)


MODULES = 2
RATE = 0.1
"""How fast the control structure's values follow those of the modules."""


class Gated(NamedTuple):
    """The control structure and the learner with its modules."""

    worth: Array  # (tiles, modules)
    inner: Any


@inlined
def chosen(gated: Gated, tile: int) -> int:
    """The module that a tile is handed to; the first of equals."""
    best = 0
    for module in range(1, MODULES):
        if gated.worth[tile, module] > gated.worth[tile, best]:
            best = module
    return best


@values_of(Gated)
def _values(gated: Gated, place: Place) -> Q:
    return values(gated.inner, Place(chosen(gated, place.tiles[0]), place.tiles))


@update_of(Gated)
def _update(gated: Gated, place: Place, action: int, error: float) -> None:
    tile = place.tiles[0]
    module = chosen(gated, tile)
    owned = Place(module, place.tiles)
    update(gated.inner, owned, action, error)
    gated.worth[tile, module] += RATE * (
        values(gated.inner, owned)[action] - gated.worth[tile, module]
    )


class TwoModules(NamedTuple):
    """An encoder in which every state may belong to either module."""

    tiles: int
    modules: int = MODULES


class GatedLearner:
    """The control structure and its modules outside the loop."""

    epsilon = None

    def __init__(self, worth: Array, inner: Learner) -> None:
        self.inner = inner
        self.stepped = Gated(worth, inner.stepped)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """``worth``, (tiles, modules), and what the modules learned."""
        return {"worth": self.stepped.worth, **self.inner.learned}

    def action_values(self, places: Sequence[Place]) -> Array:
        """Those of the module that each place is handed to."""
        owners = self.stepped.worth[[place.tiles[0] for place in places]].argmax(axis=1)
        return self.inner.action_values(
            [Place(int(owner), place.tiles) for owner, place in zip(owners, places, strict=True)]
        )


def create(beginning: Beginning) -> GatedLearner:
    """Two modules: networks with ``hidden`` layers, or tables where there are none."""
    name = Options.module(beginning.options["hidden"])
    tiles = beginning.encoder.tiles
    modules = beginning._replace(encoder=TwoModules(tiles))  # type: ignore[arg-type]
    inner = load("learners", name).create(modules)
    return GatedLearner(np.zeros((tiles, MODULES)), inner)
