"""Q as one network for all actions, with the action among its inputs (§3.3)."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from pydantic import Field
from torch import Tensor, nn

from upswing.agents.features import Place
from upswing.agents.learners import Array, Beginning, update_of, values_of
from upswing.agents.learners.backpropagation.logistic import logistic
from upswing.agents.policy import Q
from upswing.physics.jit import inlined, with_item
from upswing.study import architecture
from upswing.study.values import LayerSizes


class Options(architecture.Architecture):
    """The size of the network."""

    takes: ClassVar[tuple[architecture.Features, ...]] = ("tile",)
    hidden: Annotated[LayerSizes, Field(max_length=1)] = Field(
        min_length=1, description="Number of units of the one hidden layer."
    )


class QNetwork(nn.Module):
    """One-hot tile and one-hot action, a logistic hidden layer, a linear output; one for each module."""

    def __init__(self, modules: int, tiles: int, actions: int, hidden: int, biases: str) -> None:
        super().__init__()
        sizes = {
            "tile_weights": (modules, tiles, hidden),
            "action_weights": (modules, actions, hidden),
            "output_weights": (modules, hidden),
            **({"hidden_bias": (modules, hidden)} if biases != "none" else {}),
            **({"output_bias": (modules,)} if biases == "both" else {}),
        }
        for name, size in sizes.items():
            self.register_parameter(name, nn.Parameter(torch.zeros(size, dtype=torch.float64)))

    def forward(self, module: int, tiles: Tensor) -> Tensor:
        """Q(s, a) of one-hot ``tiles``, shape (states, tiles), as (states, actions)."""
        given = dict(self.named_parameters())
        # (states, 1, hidden) + (actions, hidden) → (states, actions, hidden)
        signal = (tiles @ given["tile_weights"][module])[:, None, :] + given["action_weights"][
            module
        ]
        if "hidden_bias" in given:
            signal = signal + given["hidden_bias"][module]
        q = torch.sigmoid(signal) @ given["output_weights"][module]
        return q + given["output_bias"][module] if "output_bias" in given else q


class ActionInput(NamedTuple):
    """The memory of such a network."""

    tile_weights: Array  # (modules, tiles, hidden)
    action_weights: Array  # (modules, actions, hidden)
    output_weights: Array  # (modules, hidden)
    hidden_bias: Array  # (modules, hidden)
    output_bias: Array  # (modules,)
    learns_hidden_bias: bool
    learns_output_bias: bool
    learning_rate: float  # η
    zeros: Q  # as many as there are actions


@inlined
def activation(net: ActionInput, module: int, tile: int, action: int, j: int) -> float:
    """What hidden unit ``j`` answers."""
    return logistic(
        net.tile_weights[module, tile, j]
        + net.action_weights[module, action, j]
        + net.hidden_bias[module, j]
    )


@inlined
def value(net: ActionInput, module: int, tile: int, action: int) -> float:
    """Q of one action."""
    total = net.output_bias[module]
    for j in range(net.output_weights.shape[1]):
        total += net.output_weights[module, j] * activation(net, module, tile, action, j)
    return float(total)


@values_of(ActionInput)
def _values(net: ActionInput, place: Place) -> Q:
    module, tile = place.module, place.tiles[0]
    q = net.zeros
    for action in range(len(q)):
        q = with_item(q, action, value(net, module, tile, action))
    return q


@update_of(ActionInput)
def _update(net: ActionInput, place: Place, action: int, error: float) -> None:
    module, tile = place.module, place.tiles[0]
    v = net.output_weights[module]
    change = net.learning_rate * error
    for j in range(v.shape[0]):
        h = activation(net, module, tile, action, j)
        hidden_change = change * v[j] * h * (1.0 - h)
        v[j] += change * h
        net.tile_weights[module, tile, j] += hidden_change
        net.action_weights[module, action, j] += hidden_change
        if net.learns_hidden_bias:
            net.hidden_bias[module, j] += hidden_change
    if net.learns_output_bias:
        net.output_bias[module] += change


class ActionInputLearner:
    """The network outside the loop."""

    epsilon = None

    def __init__(self, network: QNetwork, learning_rate: float) -> None:
        self.network = network
        given = {name: weights.detach().numpy() for name, weights in network.named_parameters()}
        modules, _, hidden = given["tile_weights"].shape
        self.stepped = ActionInput(
            given["tile_weights"],
            given["action_weights"],
            given["output_weights"],
            given.get("hidden_bias", np.zeros((modules, hidden))),
            given.get("output_bias", np.zeros(modules)),
            "hidden_bias" in given,
            "output_bias" in given,
            learning_rate,
            (0.0,) * given["action_weights"].shape[1],
        )

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """The network's ``state_dict``."""
        return {name: tensor.numpy() for name, tensor in self.network.state_dict().items()}

    def action_values(self, places: Sequence[Place]) -> Array:
        """The network of a place's module at its tile, through torch."""
        modules, tiles, _ = self.stepped.tile_weights.shape
        states = torch.eye(tiles, dtype=torch.float64)
        with torch.no_grad():
            values = torch.stack([self.network(module, states) for module in range(modules)])
        owners, here = [place.module for place in places], [place.tiles[0] for place in places]
        return np.asarray(values.numpy()[owners, here])


def create(beginning: Beginning) -> ActionInputLearner:
    """A network with weights and biases uniform in ± R11, drawn in the order of ``QNetwork``."""
    encoder, readings = beginning.encoder, beginning.readings
    (hidden,) = beginning.options["hidden"]
    network = QNetwork(encoder.modules, encoder.tiles, beginning.actions, hidden, readings.biases)
    scale = float(readings.initial_weights)
    with torch.no_grad():
        for parameter in network.parameters():
            draws = beginning.weights.uniform(-1, 1, tuple(parameter.shape))
            parameter.copy_(torch.from_numpy(scale * draws))
    return ActionInputLearner(network, float(readings.learning_rate))
