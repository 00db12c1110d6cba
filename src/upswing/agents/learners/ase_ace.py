"""The associative search and the adaptive critic element of Barto, Sutton and Anderson (1983).

The search element (ASE) has a weight for each box. It pushes right where weight and noise together are
positive, else left; between its two pushes it knows nothing. The critic element (ACE) has a weight for
each box as well, its prediction of failure. How they learn is the algorithm ``ase-ace``.
"""

from collections.abc import Mapping, Sequence
from math import erf, sqrt
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Place
from upswing.agents.learners import (
    Array,
    Beginning,
    choose_of,
    state_value_of,
    values_of,
)
from upswing.agents.policy import Q, Rule, epsilon_greedy
from upswing.physics.jit import with_item
from upswing.study import architecture

UNIT = 1_000.0
"""Weights of the ASE are in units of this: its α is 1,000 in the paper and 1 here."""

NOISE = 0.01 / UNIT
"""The standard deviation of the ASE's noise."""


class Options(architecture.Architecture):
    """It learns as its authors say."""

    holds: ClassVar[architecture.Content] = "policy"
    takes: ClassVar[tuple[architecture.Features, ...]] = ("tile",)

    def in_words(self) -> str:
        """For a reader of the page."""
        return (
            "two neuronlike elements of 1983: one pushes left or right, the other predicts failure; "
            "each has a weight for every box"
        )

    def check(self) -> None:
        """It has an algorithm of its own."""
        if self.method != "ase-ace":
            raise ValueError("ase-ace has an algorithm of its own; write `method: ase-ace`")


class AseAce(NamedTuple):
    """The weights of both elements, each (modules, tiles)."""

    search: Array  # w: the ASE's
    critic: Array  # v: the ACE's
    zeros: Q  # as many as there are actions


@values_of(AseAce)
def _values(elements: AseAce, place: Place) -> Q:
    weight = elements.search[place.module, place.tiles[0]]
    q = elements.zeros
    last = len(q) - 1
    for action in range(1, last):
        q = with_item(q, action, -abs(weight) - 1.0)  # never the best
    return with_item(with_item(q, 0, -weight), last, weight)


@state_value_of(AseAce)
def _state_value(elements: AseAce, place: Place) -> float:
    return float(elements.critic[place.module, place.tiles[0]])


@choose_of(AseAce)
def _choose(_elements: AseAce, q: Q, rule: Rule, draw: float) -> int:
    if rule.step_size == 0.0:  # it is tried out
        return epsilon_greedy(q, 0.0, rule.random_ties, draw)
    last = len(q) - 1
    # How probable it is that weight + noise > 0
    return last if draw < 0.5 * (1.0 + erf(q[last] / (NOISE * sqrt(2.0)))) else 0


class AseAceLearner:
    """The elements outside the loop."""

    epsilon = None

    def __init__(self, modules: int, tiles: int, actions: int) -> None:
        shape = (modules, tiles)
        self.stepped = AseAce(np.zeros(shape), np.zeros(shape), (0.0,) * actions)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """``search`` and ``critic``, each (modules, tiles)."""
        return {"search": self.stepped.search, "critic": self.stepped.critic}

    def action_values(self, places: Sequence[Place]) -> Array:
        """As the loop has them: how strongly each action is preferred."""
        return np.array([_values(self.stepped, place) for place in places])


def create(beginning: Beginning) -> AseAceLearner:
    """Weights of zero."""
    encoder = beginning.encoder
    return AseAceLearner(encoder.modules, encoder.tiles, beginning.actions)
