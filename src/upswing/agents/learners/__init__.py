"""Learners: what holds Q, how it is read, and how one update changes it.

A learner is a named tuple of arrays with a leading axis for modules (1 when there are none), so
that the loop can step it in place. Its file gives a body to ``values`` and ``update``, and has a
function ``create`` that makes one for a run; the loop needs to know no more. A learner that holds a
policy and no Q (§3.3) has preferences for values, the highest for its likeliest action, and a body for
``choose`` and ``state_value`` as well. Options of its own, and
which features it takes, stand there in a class ``Options``. Learners are imported by name, so that a
table never waits for torch.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Encoder
from upswing.agents.policy import Q, Rule, epsilon_greedy
from upswing.physics.jit import ByType
from upswing.physics.pendulum import Pendulum
from upswing.study.loading import load
from upswing.study.readings import Readings

Array = NDArray[np.float64]


def _values(learner: Any, place: Any) -> Q:
    """Q(s, a) of all actions, of a state in the encoder that the learner was made for."""
    raise TypeError(f"{type(learner)} is no learner")


def _update(learner: Any, place: Any, action: int, error: float) -> None:
    """Move Q(s, a) by the error signal α·δ (eq. 12)."""


def _choose(learner: Any, q: Q, rule: Rule, draw: float) -> int:
    """The action in a state whose values are ``q``, by one ``draw`` from [0, 1).

    With α = 0 a run is tried out: then every learner takes the action of the highest value.
    """
    return epsilon_greedy(q, rule.epsilon, rule.random_ties, draw)


def _state_value(learner: Any, place: Any) -> float:
    """V(s), of a learner that holds a policy."""
    raise TypeError(f"{type(learner)} holds no policy")


_values_by_type = ByType(_values)
_update_by_type = ByType(_update)
_choose_by_type = ByType(_choose)
_state_value_by_type = ByType(_state_value)

values = _values_by_type.call
update = _update_by_type.call
choose = _choose_by_type.call
state_value = _state_value_by_type.call
values_of = _values_by_type.register
update_of = _update_by_type.register
choose_of = _choose_by_type.register
state_value_of = _state_value_by_type.register


class Beginning(NamedTuple):
    """What a learner is made from."""

    encoder: Encoder
    options: Mapping[str, Any]  # of the architecture, as in the configuration
    readings: Readings
    lowest_q: float  # the smallest discounted return there can be, for a pessimistic first Q
    weights: np.random.Generator  # the stream of the first values or weights
    body: Pendulum = Pendulum()  # what moves, for learners that know it

    @property
    def accelerations(self) -> tuple[float, ...]:
        """What each action does to the cart [m/s²]."""
        return self.body.accelerations

    @property
    def actions(self) -> int:
        """How many there are."""
        return len(self.accelerations)


class Learner(Protocol):
    """A learner outside the loop."""

    @property
    def stepped(self) -> NamedTuple:
        """The arrays that the loop steps in place."""

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """What was learned, by name; the names and shapes of the weights file."""

    def action_values(self, places: Sequence[Any]) -> Array:
        """Q of every action at ``places`` of the encoder, shape (places, actions)."""

    @property
    def epsilon(self) -> float | None:
        """The share of random actions, where it is the learner's own and not the study's."""


def create(name: str, beginning: Beginning) -> Learner:
    """A fresh learner of the family ``name``, the name of a file in this folder."""
    learner: Learner = load("learners", name).create(beginning)
    return learner
