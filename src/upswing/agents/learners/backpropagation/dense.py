"""Backpropagation through one hidden layer from the state as it is, without tiles (§3.3).

The inputs are sine and cosine of φ, so that it may come round, and φ̇ in units of 20 rad/s.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Point
from upswing.agents.learners import Array, update_of, values_of
from upswing.agents.learners.backpropagation.logistic import logistic
from upswing.agents.policy import Q
from upswing.agents.traces import add_gradient, add_gradient_of, weights_of
from upswing.physics.elementary import sine_and_cosine
from upswing.physics.jit import inlined, with_item

INPUTS = 3
VELOCITY_UNIT = 20.0
"""φ̇ goes in in units of this [rad/s]: what the thesis cuts into tiles."""


class Dense(NamedTuple):
    """The memory of networks with one hidden layer, one for each action."""

    input_weights: Array  # w: (modules, actions, INPUTS, hidden)
    hidden_bias: Array  # b: (modules, actions, hidden)
    output_weights: Array  # v: (modules, actions, hidden)
    output_bias: Array  # c: (modules, actions)
    learns_hidden_bias: bool
    learns_output_bias: bool
    learning_rate: float  # η
    zeros: Q  # as many as there are actions


def dense(
    weights: Sequence[NDArray[Any]], biases: Mapping[int, NDArray[Any]], learning_rate: float
) -> Dense:
    """The stepped form of layers ``weights`` and ``biases``, sharing their memory."""
    input_weights, output_weights = weights
    modules, actions, _, hidden = input_weights.shape
    return Dense(
        input_weights=input_weights,
        hidden_bias=biases.get(0, np.zeros((modules, actions, hidden))),
        output_weights=output_weights.reshape(modules, actions, hidden),
        output_bias=biases.get(1, np.zeros((modules, actions, 1))).reshape(modules, actions),
        learns_hidden_bias=0 in biases,
        learns_output_bias=1 in biases,
        learning_rate=learning_rate,
        zeros=(0.0,) * actions,
    )


@inlined
def inputs(point: Point) -> tuple[float, float, float]:
    """What the networks are told of a state."""
    sine, cosine = sine_and_cosine(point.angle)
    return sine, cosine, point.angular_velocity / VELOCITY_UNIT


@inlined
def activation(
    net: Dense, module: int, action: int, j: int, x: tuple[float, float, float]
) -> float:
    """What hidden unit ``j`` of a network answers to inputs ``x``."""
    w = net.input_weights[module, action]
    potential = (
        net.hidden_bias[module, action, j] + x[0] * w[0, j] + x[1] * w[1, j] + x[2] * w[2, j]
    )
    return logistic(potential)


@inlined
def value(net: Dense, module: int, action: int, x: tuple[float, float, float]) -> float:
    """Q of one action."""
    v = net.output_weights[module, action]
    total = net.output_bias[module, action]
    for j in range(v.shape[0]):
        total += v[j] * activation(net, module, action, j, x)
    return float(total)


@values_of(Dense)
def _values(net: Dense, point: Point) -> Q:
    x = inputs(point)
    q = net.zeros
    for action in range(len(q)):
        q = with_item(q, action, value(net, point.module, action, x))
    return q


@add_gradient_of(Dense)
def _add_gradient(net: Dense, into: Dense, point: Point, action: int, share: float) -> None:
    x, module = inputs(point), point.module
    w, b = into.input_weights[module, action], into.hidden_bias[module, action]
    v, into_v = net.output_weights[module, action], into.output_weights[module, action]
    change = net.learning_rate * share
    for j in range(v.shape[0]):
        h = activation(net, module, action, j, x)
        hidden_change = change * v[j] * h * (1.0 - h)
        into_v[j] += change * h
        for i in range(INPUTS):
            w[i, j] += hidden_change * x[i]
        if net.learns_hidden_bias:
            b[j] += hidden_change
    if net.learns_output_bias:
        into.output_bias[module, action] += change


@update_of(Dense)
def _update(net: Dense, point: Point, action: int, error: float) -> None:
    add_gradient(net, net, point, action, error)


@weights_of(Dense)
def _weights(net: Dense) -> tuple[Array, ...]:
    return (
        net.input_weights.reshape(-1),
        net.hidden_bias.reshape(-1),
        net.output_weights.reshape(-1),
        net.output_bias.reshape(-1),
    )
