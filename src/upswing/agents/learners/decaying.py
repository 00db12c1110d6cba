"""A table whose step sizes decay as the convergence theorem of Q-learning asks (§3.1.4).

Every entry has its own: after n updates of it, α_n = α / (1 + n / h), where h is ``halved_after``. So
Σ α_n = ∞ and Σ α_n² < ∞ (Watkins and Dayan 1992). With α = 1 and h = 1 an entry is the average of
all its targets.
"""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from upswing.agents.features import Place
from upswing.agents.learners import Array, Beginning, update, update_of, values, values_of
from upswing.agents.learners.table import Table, TableLearner, first_table
from upswing.agents.policy import Q
from upswing.study import architecture
from upswing.study.values import Positive


class Options(architecture.Architecture):
    """How fast the step sizes decay."""

    takes: ClassVar[tuple[architecture.Features, ...]] = ("tile", "tiles")
    halved_after: Positive = Field(description="Number of updates of an entry that halve its α.")


class Decaying(NamedTuple):
    """A table, and how often each entry was updated."""

    table: Table
    updates: Array  # (modules, tiles, actions)
    halved_after: float  # h


@values_of(Decaying)
def _values(decaying: Decaying, place: Place) -> Q:
    return values(decaying.table, place)


@update_of(Decaying)
def _update(decaying: Decaying, place: Place, action: int, error: float) -> None:
    updates = decaying.updates[place.module, place.tiles[0], action]
    update(decaying.table, place, action, error / (1.0 + updates / decaying.halved_after))
    for tile in place.tiles:
        decaying.updates[place.module, tile, action] += 1.0


class DecayingLearner:
    """Such a table outside the loop."""

    epsilon = None

    def __init__(self, q: Array, halved_after: float) -> None:
        self.inner = TableLearner(q)
        self.stepped = Decaying(self.inner.stepped, np.zeros(q.shape), halved_after)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """``q`` and ``updates``, each (modules, tiles, actions)."""
        return {**self.inner.learned, "updates": self.stepped.updates}

    def action_values(self, places: Sequence[Place]) -> Array:
        """Those of the table."""
        return self.inner.action_values(places)


def create(beginning: Beginning) -> DecayingLearner:
    """A table with the first Q of R5 and nothing updated."""
    return DecayingLearner(first_table(beginning), float(beginning.options["halved_after"]))
