"""Backpropagation through two hidden layers, one sample at a time (§4.6.2: 160-20-5-1).

What was computed for a tile is kept as in ``one_hidden``, the second layer's activations too.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Place
from upswing.agents.learners import Array, update_of, values_of
from upswing.agents.learners.backpropagation.logistic import logistic
from upswing.agents.learners.backpropagation.one_hidden import Kept, activate, forget, nothing_kept
from upswing.agents.learners.backpropagation.product import product
from upswing.agents.policy import Q
from upswing.physics.jit import inlined, with_item


class TwoHidden(NamedTuple):
    """The memory of networks with two hidden layers."""

    input_weights: Array  # (modules, actions, tiles, first)
    first_bias: Array  # (modules, actions, first)
    middle_weights: Array  # (modules, actions, second, first)
    second_bias: Array  # (modules, actions, second)
    output_weights: Array  # (modules, actions, second)
    output_bias: Array  # (modules, actions)
    learns_hidden_bias: bool
    learns_output_bias: bool
    learning_rate: float  # η
    zeros: Q  # as many as there are actions
    kept: Kept
    second: Array  # kept activations of the second layer, as old as kept.q
    backward: Array  # room for the error signal that reaches the first layer: (first,)


def two_hidden(
    weights: Sequence[NDArray[Any]], biases: Mapping[int, NDArray[Any]], learning_rate: float
) -> TwoHidden:
    """The stepped form of layers ``weights`` and ``biases``, sharing their memory."""
    input_weights, middle_weights, output_weights = weights
    modules, actions, tiles, _ = input_weights.shape
    _, _, second, first = middle_weights.shape
    return TwoHidden(
        input_weights=input_weights,
        first_bias=biases.get(0, np.zeros((modules, actions, first))),
        middle_weights=middle_weights,
        second_bias=biases.get(1, np.zeros((modules, actions, second))),
        output_weights=output_weights.reshape(modules, actions, second),
        output_bias=biases.get(2, np.zeros((modules, actions, 1))).reshape(modules, actions),
        learns_hidden_bias=0 in biases,
        learns_output_bias=2 in biases,
        learning_rate=learning_rate,
        zeros=(0.0,) * actions,
        kept=nothing_kept(input_weights.shape),
        second=np.zeros((modules, actions, tiles, second)),
        backward=np.zeros(first),
    )


@inlined
def evaluate(net: TwoHidden, module: int, action: int, tile: int) -> None:
    """Make what is kept of a tile that of today's weights."""
    kept = net.kept
    if kept.q_at[module, action, tile] == kept.updates[module, action]:
        return
    activate(kept, net.input_weights, net.first_bias, module, action, tile)
    h, g = kept.hidden[module, action, tile], net.second[module, action, tile]
    u, b = net.middle_weights[module, action], net.second_bias[module, action]
    v = net.output_weights[module, action]
    for k in range(g.shape[0]):
        g[k] = b[k] + product(u[k], h)
    for k in range(g.shape[0]):
        g[k] = logistic(g[k])
    kept.q[module, action, tile] = net.output_bias[module, action] + product(v, g)
    kept.q_at[module, action, tile] = kept.updates[module, action]


@values_of(TwoHidden)
def _values(net: TwoHidden, place: Place) -> Q:
    kept, module, tile = net.kept, place.module, place.tiles[0]
    q = net.zeros
    for action in range(len(q)):
        evaluate(net, module, action, tile)
    # In a loop of its own, as in one_hidden.py.
    for action in range(len(q)):
        q = with_item(q, action, kept.q[module, action, tile])
    return q


@update_of(TwoHidden)
def _update(net: TwoHidden, place: Place, action: int, error: float) -> None:
    module, tile = place.module, place.tiles[0]
    evaluate(net, module, action, tile)
    w, a = net.input_weights[module, action, tile], net.first_bias[module, action]
    u, b = net.middle_weights[module, action], net.second_bias[module, action]
    v = net.output_weights[module, action]
    h, g = net.kept.hidden[module, action, tile], net.second[module, action, tile]
    backward = net.backward
    change = net.learning_rate * error
    for j in range(h.shape[0]):
        backward[j] = 0.0
    for k in range(g.shape[0]):
        second_change = change * v[k] * g[k] * (1.0 - g[k])
        v[k] += change * g[k]
        if net.learns_hidden_bias:
            b[k] += second_change
        for j in range(h.shape[0]):
            backward[j] += u[k, j] * second_change
            u[k, j] += second_change * h[j]
    for j in range(h.shape[0]):
        first_change = backward[j] * h[j] * (1.0 - h[j])
        w[j] += first_change
        if net.learns_hidden_bias:
            a[j] += first_change
    if net.learns_output_bias:
        net.output_bias[module, action] += change
    forget(net.kept, net.learns_hidden_bias, module, action, tile)
