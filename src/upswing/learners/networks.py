"""Q as feed-forward networks, one for each module and action (§3.2.2, §4.5.2, §4.6.2).

torch owns the networks: architecture, first weights, ``state_dict``, evaluation. The compiled loop
steps the same memory in place, one sample at a time.
"""

from collections.abc import Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from upswing.learners import Array, Beginning
from upswing.learners.one_hidden import one_hidden
from upswing.learners.two_hidden import two_hidden
from upswing.tasks import ACTIONS


class QNetworks(nn.Module):
    """Modules × actions networks of equal shape: one-hot tiles, logistic hidden units, a linear output.

    Layer k has ``weights[k]``, shape (modules, actions, outputs, inputs), only the first one
    (modules, actions, inputs, outputs), so that a tile's own weights lie side by side; and, where
    R10 gives it one, ``biases[k]``, shape (modules, actions, outputs).
    """

    def __init__(self, modules: int, sizes: tuple[int, ...], biases: str) -> None:
        super().__init__()
        shapes = list(pairwise((*sizes, 1)))
        last = len(shapes) - 1
        self.weights = nn.ParameterList(
            torch.zeros(modules, ACTIONS, *shape, dtype=torch.float64)
            for shape in (shapes[0], *(reversed(shape) for shape in shapes[1:]))
        )
        self.biases = nn.ParameterDict(
            {
                str(layer): nn.Parameter(
                    torch.zeros(modules, ACTIONS, outputs, dtype=torch.float64)
                )
                for layer, (_, outputs) in enumerate(shapes)
                if biases == "both" or (biases == "hidden" and layer != last)
            }
        )

    def forward(self, module: int, tiles: Tensor) -> Tensor:
        """Q(s, a) of one-hot ``tiles``, shape (states, tiles), as (states, actions)."""
        # (states, tiles) → (actions, states, outputs), layer by layer
        signal = tiles.expand(ACTIONS, *tiles.shape)
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

    def __init__(self, networks: QNetworks, learning_rate: float) -> None:
        self.networks = networks
        weights = [parameter.detach().numpy() for parameter in networks.weights]
        biases = {
            int(layer): parameter.detach().numpy() for layer, parameter in networks.biases.items()
        }
        stepped = one_hidden if len(weights) == 2 else two_hidden
        self.stepped: NamedTuple = stepped(weights, biases, learning_rate)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """The networks' ``state_dict``."""
        return {name: tensor.numpy() for name, tensor in self.networks.state_dict().items()}

    def action_values(self) -> Array:
        """Every network at every tile, through torch."""
        modules, _, tiles, _ = self.networks.weights[0].shape
        states = torch.eye(tiles, dtype=torch.float64)
        with torch.no_grad():
            values = torch.stack([self.networks(module, states) for module in range(modules)])
        return np.asarray(values.numpy())


def create(beginning: Beginning) -> NetworksLearner:
    """Networks with weights and biases uniform in ± R11, drawn in the order of the layers."""
    tiles, readings = beginning.tiles, beginning.readings
    networks = QNetworks(tiles.modules, (tiles.tiles, *beginning.hidden), readings.biases)
    scale = float(readings.initial_weights)
    with torch.no_grad():
        for parameter in networks.parameters():
            draws = beginning.weights.uniform(-1, 1, tuple(parameter.shape))
            parameter.copy_(torch.from_numpy(scale * draws))
    return NetworksLearner(networks, float(readings.learning_rate))
