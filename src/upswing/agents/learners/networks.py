"""Q as feed-forward networks, one for each module and action (§3.2.2, §4.5.2, §4.6.2).

torch owns the networks: architecture, first weights, ``state_dict``, evaluation. The compiled loop
steps the same memory in place, one sample at a time.
"""

from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import Any, ClassVar, NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from pydantic import Field
from torch import Tensor, nn

from upswing.agents.learners import Array, Beginning
from upswing.agents.learners.backpropagation.dense import INPUTS, dense, inputs
from upswing.agents.learners.backpropagation.one_hidden import one_hidden
from upswing.agents.learners.backpropagation.two_hidden import two_hidden
from upswing.study import architecture
from upswing.study.values import LayerSizes


class Options(architecture.Architecture):
    """The shape of a network."""

    takes: ClassVar[tuple[architecture.Features, ...]] = ("tile", "state")
    hidden: LayerSizes = Field(
        min_length=1,
        description="Numbers of units of one or two hidden layers, input side first.",
    )

    def in_words(self) -> str:
        """For a reader of the page."""
        units = " and ".join(map(str, self.hidden))
        told = "a one-hot input for the tile" if self.gives == "tile" else "the state as input"
        return (
            f"a network for each action: {told}, {units} logistic hidden units, one linear "
            "output; an update moves the weights by η α δ times the gradient, where δ is the TD error "
            "and η backpropagation’s own rate (R12)"
        )

    def check(self) -> None:
        """There is one hidden layer where the state itself goes in."""
        if self.gives == "state" and len(self.hidden) > 1:
            raise ValueError("`hidden` has one size here: there is one hidden layer")


class QNetworks(nn.Module):
    """Modules × actions networks of equal shape: inputs, logistic hidden units, a linear output.

    Layer k has ``weights[k]``, shape (modules, actions, outputs, inputs), only the first one
    (modules, actions, inputs, outputs), so that a tile's own weights lie side by side; and, where
    R10 gives it one, ``biases[k]``, shape (modules, actions, outputs).
    """

    def __init__(self, modules: int, actions: int, sizes: tuple[int, ...], biases: str) -> None:
        super().__init__()
        self.actions = actions
        shapes = list(pairwise((*sizes, 1)))
        last = len(shapes) - 1
        self.weights = nn.ParameterList(
            torch.zeros(modules, actions, *shape, dtype=torch.float64)
            for shape in (shapes[0], *(reversed(shape) for shape in shapes[1:]))
        )
        self.biases = nn.ParameterDict(
            {
                str(layer): nn.Parameter(
                    torch.zeros(modules, actions, outputs, dtype=torch.float64)
                )
                for layer, (_, outputs) in enumerate(shapes)
                if biases == "both" or (biases == "hidden" and layer != last)
            }
        )

    def forward(self, module: int, tiles: Tensor) -> Tensor:
        """Q(s, a) of inputs (states, inputs), one-hot tiles for example, as (states, actions)."""
        # (states, tiles) → (actions, states, outputs), layer by layer
        signal = tiles.expand(self.actions, *tiles.shape)
        for layer, weights in enumerate(self.weights):
            into = weights[module] if layer == 0 else weights[module].mT
            signal = signal @ into
            if str(layer) in self.biases:
                signal = signal + self.biases[str(layer)][module][:, None, :]
            if layer < len(self.weights) - 1:
                signal = torch.sigmoid(signal)  # eq. 26
        return signal[..., 0].T


class NetworksLearner:
    """Networks outside the loop."""

    epsilon = None

    def __init__(self, networks: QNetworks, tiled: bool, learning_rate: float) -> None:
        self.networks = networks
        weights = [parameter.detach().numpy() for parameter in networks.weights]
        biases = {
            int(layer): parameter.detach().numpy() for layer, parameter in networks.biases.items()
        }
        if not tiled:
            stepped: Callable[..., NamedTuple] = dense
        else:
            stepped = one_hidden if len(weights) == 2 else two_hidden
        self.tiled = tiled
        self.stepped = stepped(weights, biases, learning_rate)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """The networks' ``state_dict``."""
        return {name: tensor.numpy() for name, tensor in self.networks.state_dict().items()}

    def action_values(self, places: Sequence[Any]) -> Array:
        """The networks of a place's module, through torch."""
        modules, _, told, _ = self.networks.weights[0].shape
        if self.tiled:
            states, here = (
                torch.eye(told, dtype=torch.float64),
                [place.tiles[0] for place in places],
            )
        else:
            states = torch.tensor([inputs(point) for point in places], dtype=torch.float64)
            here = list(range(len(places)))
        with torch.no_grad():
            values = torch.stack([self.networks(module, states) for module in range(modules)])
        return np.asarray(values.numpy()[[place.module for place in places], here])


def create(beginning: Beginning) -> NetworksLearner:
    """Networks with weights and biases uniform in ± R11, drawn in the order of the layers."""
    encoder, readings = beginning.encoder, beginning.readings
    tiled = encoder.tiles > 0
    sizes = (encoder.tiles if tiled else INPUTS, *beginning.options["hidden"])
    networks = QNetworks(encoder.modules, beginning.actions, sizes, readings.biases)
    scale = float(readings.initial_weights)
    with torch.no_grad():
        for parameter in networks.parameters():
            draws = beginning.weights.uniform(-1, 1, tuple(parameter.shape))
            parameter.copy_(torch.from_numpy(scale * draws))
    return NetworksLearner(networks, tiled, float(readings.learning_rate))
