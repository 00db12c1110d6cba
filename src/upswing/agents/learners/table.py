"""Q as a table: one entry for each module, tile and action (§3.1)."""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Place
from upswing.agents.learners import Array, Beginning, update_of, values_of
from upswing.agents.policy import Q
from upswing.physics.jit import with_item
from upswing.study import architecture


class Options(architecture.Architecture):
    """Where tiles overlap, Q is the sum of their entries."""

    takes: ClassVar[tuple[architecture.Features, ...]] = ("tile", "tiles")

    def in_words(self) -> str:
        """For a reader of the page."""
        return "a table of Q with an entry for each tile and action"


class Table(NamedTuple):
    """The table that the loop steps."""

    q: Array  # (modules, tiles, actions)
    zeros: Q  # as many as there are actions


@values_of(Table)
def _values(table: Table, place: Place) -> Q:
    q, module, first = table.zeros, place.module, place.tiles[0]
    for action in range(len(q)):
        value = table.q[module, first, action]
        for other in range(1, len(place.tiles)):  # tilings overlap: Q is the sum of a state's tiles
            value += table.q[module, place.tiles[other], action]
        q = with_item(q, action, value)
    return q


@update_of(Table)
def _update(table: Table, place: Place, action: int, error: float) -> None:
    share = error / len(place.tiles)
    for tile in place.tiles:
        table.q[place.module, tile, action] += share  # Q(s, a) ← Q(s, a) + α·δ, eq. 12


class TableLearner:
    """A table outside the loop."""

    epsilon = None

    def __init__(self, q: Array) -> None:
        self.stepped = Table(q, (0.0,) * q.shape[-1])

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """``q``: (modules, tiles, actions)."""
        return {"q": self.stepped.q}

    def action_values(self, places: Sequence[Place]) -> Array:
        """The entries of the places, summed over their tiles."""
        modules = np.array([place.module for place in places])
        tiles = np.array([place.tiles for place in places])
        values: Array = self.stepped.q[modules[:, None], tiles].sum(axis=1)
        return values


def create(beginning: Beginning) -> TableLearner:
    """A table with the first Q of R5."""
    return TableLearner(first_table(beginning))


def first_table(beginning: Beginning) -> Array:
    """The first Q of R5, (modules, tiles, actions): zero, the lowest return, or uniform between."""
    encoder, lowest = beginning.encoder, beginning.lowest_q
    shape = (encoder.modules, encoder.tiles, beginning.actions)
    match beginning.readings.first_q:
        case "zero":
            return np.zeros(shape)
        case "pessimistic":
            return np.full(shape, lowest)
        case "random":
            return lowest * beginning.weights.random(shape)
