"""Q as a linear function of features, one for each action: Q(s, a) = Σ wᵢ xᵢ(s) (§3.1.5).

The gradient by the weights is x(s) itself, so an update is w ← w + α·δ·x(s). It is called semi-gradient
because the target that δ contains depends on the weights, too, and is taken as given.
"""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Encoder, Point, activate
from upswing.agents.learners import Array, Beginning, update_of, values_of
from upswing.agents.learners.backpropagation.product import product
from upswing.agents.policy import Q
from upswing.agents.traces import add_gradient, add_gradient_of, weights_of
from upswing.physics.jit import compiled, with_item
from upswing.study import architecture


class Options(architecture.Architecture):
    """It weighs features that are numbers; on tiles a table is the same."""

    takes: ClassVar[tuple[architecture.Features, ...]] = ("activations",)

    def in_words(self) -> str:
        """For a reader of the page."""
        return "a linear function for each action, with a weight for every feature of the state"


class Work(NamedTuple):
    """What is no weight: the features of the state that was asked for last."""

    features: Array  # x: (tiles,)


class Linear(NamedTuple):
    """The weights that the loop steps, and what it needs to step them."""

    weights: Array  # w: (actions, tiles)
    encoder: Any
    work: Work
    zeros: Q  # as many as there are actions


@values_of(Linear)
def _values(linear: Linear, point: Point) -> Q:
    x, q = linear.work.features, linear.zeros
    activate(linear.encoder, point, x)
    for action in range(len(q)):
        q = with_item(q, action, product(linear.weights[action], x))
    return q


@add_gradient_of(Linear)
def _add_gradient(linear: Linear, into: Linear, point: Point, action: int, share: float) -> None:
    x = linear.work.features
    activate(linear.encoder, point, x)
    w = into.weights[action]
    for i in range(x.shape[0]):
        w[i] += share * x[i]


@update_of(Linear)
def _update(linear: Linear, point: Point, action: int, error: float) -> None:
    add_gradient(linear, linear, point, action, error)


@weights_of(Linear)
def _weights(linear: Linear) -> tuple[Array, ...]:
    return (linear.weights.reshape(-1),)


@compiled
def activate_all(encoder: Any, states: Array, features: Array) -> None:
    """Write the features of ``states``, (states, 2) [rad, rad/s], into ``features``, (states, tiles)."""
    for i in range(states.shape[0]):
        activate(encoder, Point(0, states[i, 0], states[i, 1]), features[i])


class LinearLearner:
    """The weights outside the loop."""

    epsilon = None

    def __init__(self, encoder: Encoder, actions: int) -> None:
        weights, work = np.zeros((actions, encoder.tiles)), Work(np.zeros(encoder.tiles))
        self.stepped = Linear(weights, encoder, work, (0.0,) * actions)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """``weights``: (actions, features)."""
        return {"weights": self.stepped.weights}

    def action_values(self, places: Sequence[Point]) -> Array:
        """The weights times the features of every place."""
        features = np.empty((len(places), self.stepped.encoder.tiles))
        states = np.array([(place.angle, place.angular_velocity) for place in places])
        activate_all(self.stepped.encoder, states, features)
        values: Array = features @ self.stepped.weights.T
        return values


def create(beginning: Beginning) -> LinearLearner:
    """Weights of zero."""
    return LinearLearner(beginning.encoder, beginning.actions)
