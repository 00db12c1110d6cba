"""Backpropagation through one hidden layer, one sample at a time (§3.2.2, §4.5.2).

The same numbers as computing every network anew at every step, in a fraction of the time, because
nothing is computed twice. The input is one-hot: a tile's hidden activations depend on that tile's
own weights and on the hidden biases alone. They are kept from visit to visit, and so is Q; both are
computed again only when an update has touched what they depend on.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Place
from upswing.agents.learners import Array, update_of, values_of
from upswing.agents.learners.backpropagation.logistic import logistic
from upswing.agents.learners.backpropagation.product import product
from upswing.agents.policy import Q
from upswing.agents.traces import add_gradient_of, forget_kept_of, weights_of
from upswing.physics.jit import inlined, with_item

Counter = NDArray[np.int64]
STALE = -1


class Kept(NamedTuple):
    """What was computed for a tile, and after how many updates; axes (modules, actions, tiles)."""

    hidden: Array  # activations of the first hidden layer: (modules, actions, tiles, hidden)
    hidden_at: Counter
    q: Array
    q_at: Counter
    hidden_updates: (
        Counter  # updates that changed the hidden layer of all tiles: (modules, actions)
    )
    updates: Counter  # all updates of a network: (modules, actions)


class OneHidden(NamedTuple):
    """The memory of networks with one hidden layer."""

    input_weights: Array  # w: (modules, actions, tiles, hidden)
    hidden_bias: Array  # b: (modules, actions, hidden)
    output_weights: Array  # v: (modules, actions, hidden)
    output_bias: Array  # c: (modules, actions)
    learns_hidden_bias: bool
    learns_output_bias: bool
    learning_rate: float  # η
    zeros: Q  # as many as there are actions
    kept: Kept


def one_hidden(
    weights: Sequence[NDArray[Any]], biases: Mapping[int, NDArray[Any]], learning_rate: float
) -> OneHidden:
    """The stepped form of layers ``weights`` and ``biases``, sharing their memory."""
    input_weights, output_weights = weights
    modules, actions, _, hidden = input_weights.shape
    return OneHidden(
        input_weights=input_weights,
        hidden_bias=biases.get(0, np.zeros((modules, actions, hidden))),
        output_weights=output_weights.reshape(modules, actions, hidden),
        output_bias=biases.get(1, np.zeros((modules, actions, 1))).reshape(modules, actions),
        learns_hidden_bias=0 in biases,
        learns_output_bias=1 in biases,
        learning_rate=learning_rate,
        zeros=(0.0,) * actions,
        kept=nothing_kept(input_weights.shape),
    )


def nothing_kept(shape: tuple[int, ...]) -> Kept:
    """Room for what is kept, for input weights of ``shape`` (modules, actions, tiles, hidden)."""
    return Kept(
        hidden=np.zeros(shape),
        hidden_at=np.full(shape[:3], STALE),
        q=np.zeros(shape[:3]),
        q_at=np.full(shape[:3], STALE),
        hidden_updates=np.zeros(shape[:2], dtype=np.int64),
        updates=np.zeros(shape[:2], dtype=np.int64),
    )


@inlined
def activate(
    kept: Kept, input_weights: Array, hidden_bias: Array, module: int, action: int, tile: int
) -> None:
    """Make the kept hidden activations of a tile those of today's weights."""
    if kept.hidden_at[module, action, tile] == kept.hidden_updates[module, action]:
        return
    w, b = input_weights[module, action, tile], hidden_bias[module, action]
    h = kept.hidden[module, action, tile]
    for j in range(h.shape[0]):
        h[j] = logistic(w[j] + b[j])
    kept.hidden_at[module, action, tile] = kept.hidden_updates[module, action]


@inlined
def forget(kept: Kept, learns_hidden_bias: bool, module: int, action: int, tile: int) -> None:
    """Note what an update of a network at a tile has made stale."""
    kept.updates[module, action] += 1
    if learns_hidden_bias:
        kept.hidden_updates[module, action] += 1
    else:
        kept.hidden_at[module, action, tile] = STALE


@values_of(OneHidden)
def _values(net: OneHidden, place: Place) -> Q:
    kept, module, tile = net.kept, place.module, place.tiles[0]
    q = net.zeros
    for action in range(len(q)):
        if kept.q_at[module, action, tile] != kept.updates[module, action]:
            activate(kept, net.input_weights, net.hidden_bias, module, action, tile)
            v, h = net.output_weights[module, action], kept.hidden[module, action, tile]
            kept.q[module, action, tile] = net.output_bias[module, action] + product(v, h)
            kept.q_at[module, action, tile] = kept.updates[module, action]
    # In a loop of its own, which the compiler unrolls: together a step takes 5 % more.
    for action in range(len(q)):
        q = with_item(q, action, kept.q[module, action, tile])
    return q


@update_of(OneHidden)
def _update(net: OneHidden, place: Place, action: int, error: float) -> None:
    module, tile = place.module, place.tiles[0]
    activate(net.kept, net.input_weights, net.hidden_bias, module, action, tile)
    w, v = net.input_weights[module, action, tile], net.output_weights[module, action]
    b, h = net.hidden_bias[module, action], net.kept.hidden[module, action, tile]
    change = net.learning_rate * error
    for j in range(h.shape[0]):
        hidden_change = change * v[j] * h[j] * (1.0 - h[j])
        v[j] += change * h[j]
        w[j] += hidden_change
        if net.learns_hidden_bias:
            b[j] += hidden_change
    if net.learns_output_bias:
        net.output_bias[module, action] += change
    forget(net.kept, net.learns_hidden_bias, module, action, tile)


@add_gradient_of(OneHidden)
def _add_gradient(net: OneHidden, into: OneHidden, place: Place, action: int, share: float) -> None:
    # As in an update, which has a body of its own because this one takes 5 % more of a step.
    module, tile = place.module, place.tiles[0]
    activate(net.kept, net.input_weights, net.hidden_bias, module, action, tile)
    w, b = into.input_weights[module, action, tile], into.hidden_bias[module, action]
    v, into_v = net.output_weights[module, action], into.output_weights[module, action]
    h = net.kept.hidden[module, action, tile]
    change = net.learning_rate * share
    for j in range(h.shape[0]):
        hidden_change = change * v[j] * h[j] * (1.0 - h[j])
        into_v[j] += change * h[j]
        w[j] += hidden_change
        if net.learns_hidden_bias:
            b[j] += hidden_change
    if net.learns_output_bias:
        into.output_bias[module, action] += change


@weights_of(OneHidden)
def _weights(net: OneHidden) -> tuple[Array, ...]:
    return (
        net.input_weights.reshape(-1),
        net.hidden_bias.reshape(-1),
        net.output_weights.reshape(-1),
        net.output_bias.reshape(-1),
    )


@forget_kept_of(OneHidden)
def _forget_kept(net: OneHidden) -> None:
    for module in range(net.kept.updates.shape[0]):
        for action in range(net.kept.updates.shape[1]):
            net.kept.updates[module, action] += 1
            net.kept.hidden_updates[module, action] += 1
