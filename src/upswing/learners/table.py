"""Q as a table: one entry for each module, tile and action (§3.1)."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.learners import Array, Beginning, Q, update_of, values_of
from upswing.tasks import ACTIONS


class Table(NamedTuple):
    """The table that the loop steps."""

    q: Array  # (modules, tiles, actions)


@values_of(Table)
def _values(table: Table, module: int, tile: int) -> Q:
    return table.q[module, tile, 0], table.q[module, tile, 1], table.q[module, tile, 2]


@update_of(Table)
def _update(table: Table, module: int, tile: int, action: int, error: float) -> None:
    table.q[module, tile, action] += error  # Q(s, a) ← Q(s, a) + α·δ, eq. 12


class TableLearner:
    """A table outside the loop."""

    epsilon = None

    def __init__(self, q: Array) -> None:
        self.stepped = Table(q)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """``q``: (modules, tiles, actions)."""
        return {"q": self.stepped.q}

    def action_values(self) -> Array:
        """The table itself."""
        return self.stepped.q


def create(beginning: Beginning) -> TableLearner:
    """A table with the first Q of R5: zero, the lowest return, or uniform between the two."""
    shape = (beginning.tiles.modules, beginning.tiles.tiles, ACTIONS)
    match beginning.readings.first_q:
        case "zero":
            q = np.zeros(shape)
        case "pessimistic":
            q = np.full(shape, beginning.lowest_q)
        case "random":
            q = beginning.lowest_q * beginning.weights.random(shape)
    return TableLearner(q)
