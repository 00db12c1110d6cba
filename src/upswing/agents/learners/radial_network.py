"""Q as radial basis function networks whose centres and widths are learned too (§3.1.5).

There is one network for each action, as with the thesis's networks (§3.2.2), of Gaussian units:

    Q(s, a) = Σⱼ vⱼ hⱼ      hⱼ = exp(−½ Σᵢ (xᵢ − cⱼᵢ)² / σⱼᵢ²)      x = (sin φ, cos φ, φ̇ / 20)

An update moves v by α·δ times the gradient, c and 1/σ by ``rate``·α·δ times theirs. A width is learned
as 1/σ, which may be 0 or negative: only its square counts. torch owns the networks, and the loop steps
the same memory in place.
"""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, ClassVar, NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from pydantic import Field
from torch import Tensor, nn

from upswing.agents.features import Point
from upswing.agents.learners import Array, Beginning, update_of, values_of
from upswing.agents.learners.backpropagation.dense import INPUTS, VELOCITY_UNIT, inputs
from upswing.agents.policy import Q
from upswing.agents.traces import add_gradient, add_gradient_of, weights_of
from upswing.physics.elementary import exp_of_negative
from upswing.physics.jit import inlined, with_item
from upswing.study import architecture
from upswing.study.values import LayerSizes, NotNegative, Positive


class Options(architecture.Architecture):
    """How many units there are, and how their centres and widths begin and move."""

    takes: ClassVar[tuple[architecture.Features, ...]] = ("state",)
    hidden: Annotated[LayerSizes, Field(max_length=1)] = Field(
        min_length=1, description="Number of Gaussian units of each network."
    )
    width: Positive = Field(
        default=0.5,
        description="The first σ of the units, where sin φ, cos φ and φ̇ / 20 reach from −1 to 1.",
    )
    rate: NotNegative = Field(
        default=0.1,
        description="The step size of centres and widths, as a multiple of α; 0 keeps them fixed.",
    )

    def in_words(self) -> str:
        """For a reader of the page."""
        return (
            f"a radial basis function network for each action: {self.hidden[0]} Gaussian units around "
            "centres that it learns, with widths that it learns, and a linear output"
        )


class RadialNetworks(nn.Module):
    """Networks of Gaussian units, one for each action; all of float64.

    ``centres`` and ``inverse_widths``, which is 1/σ, have shape (actions, units, inputs), ``weights``
    (actions, units).
    """

    def __init__(self, centres: Tensor, width: float) -> None:
        super().__init__()
        self.centres = nn.Parameter(centres)
        self.inverse_widths = nn.Parameter(torch.full_like(centres, 1 / width))
        self.weights = nn.Parameter(torch.zeros(centres.shape[:2], dtype=torch.float64))

    def forward(self, x: Tensor) -> Tensor:
        """Q(s, a) of inputs (states, inputs), as (states, actions)."""
        away = (x[:, None, None, :] - self.centres) * self.inverse_widths
        return ((-0.5 * away.square().sum(-1)).exp() * self.weights).sum(-1)


class RadialNetwork(NamedTuple):
    """The memory of such networks."""

    centres: Array  # c: (actions, units, INPUTS)
    inverse_widths: Array  # 1/σ: (actions, units, INPUTS)
    weights: Array  # v: (actions, units)
    rate: float  # of centres and widths
    zeros: Q  # as many as there are actions


@inlined
def activation(net: RadialNetwork, action: int, j: int, x: tuple[float, float, float]) -> float:
    """What unit ``j`` answers to inputs ``x``."""
    c, per_width, total = net.centres[action, j], net.inverse_widths[action, j], 0.0
    for i in range(INPUTS):
        away = (x[i] - c[i]) * per_width[i]
        total += away * away
    return exp_of_negative(-0.5 * total)


@values_of(RadialNetwork)
def _values(net: RadialNetwork, point: Point) -> Q:
    x, q = inputs(point), net.zeros
    for action in range(len(q)):
        value = 0.0
        for j in range(net.weights.shape[1]):
            value += net.weights[action, j] * activation(net, action, j, x)
        q = with_item(q, action, value)
    return q


@add_gradient_of(RadialNetwork)
def _add_gradient(
    net: RadialNetwork, into: RadialNetwork, point: Point, action: int, share: float
) -> None:
    x = inputs(point)
    for j in range(net.weights.shape[1]):
        h = activation(net, action, j, x)
        inner = share * net.rate * net.weights[action, j] * h
        into.weights[action, j] += share * h
        for i in range(INPUTS):
            away, per_width = x[i] - net.centres[action, j, i], net.inverse_widths[action, j, i]
            into.centres[action, j, i] += inner * away * per_width * per_width
            into.inverse_widths[action, j, i] -= inner * away * away * per_width


@update_of(RadialNetwork)
def _update(net: RadialNetwork, point: Point, action: int, error: float) -> None:
    add_gradient(net, net, point, action, error)


@weights_of(RadialNetwork)
def _weights(net: RadialNetwork) -> tuple[Array, ...]:
    return net.centres.reshape(-1), net.inverse_widths.reshape(-1), net.weights.reshape(-1)


class RadialNetworkLearner:
    """The networks outside the loop."""

    epsilon = None

    def __init__(self, networks: RadialNetworks, rate: float) -> None:
        self.networks = networks
        memory = {name: values.detach().numpy() for name, values in networks.named_parameters()}
        actions = memory["weights"].shape[0]
        self.stepped = RadialNetwork(**memory, rate=rate, zeros=(0.0,) * actions)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """The networks' ``state_dict``."""
        return {name: tensor.numpy() for name, tensor in self.networks.state_dict().items()}

    def action_values(self, places: Sequence[Point]) -> Array:
        """The networks' outputs, through torch."""
        x = torch.tensor([inputs(point) for point in places], dtype=torch.float64)
        with torch.no_grad():
            return np.asarray(self.networks(x).numpy())


def create(beginning: Beginning) -> RadialNetworkLearner:
    """Centres drawn over the states that a picture shows, φ before φ̇; Q begins at zero."""
    options, over = beginning.options, beginning.encoder.picture
    shape = (beginning.actions, options["hidden"][0])
    angle = over.angle_limit * beginning.weights.uniform(-1, 1, shape)
    velocity = over.velocity_limit * beginning.weights.uniform(-1, 1, shape)
    centres = np.stack([np.sin(angle), np.cos(angle), velocity / VELOCITY_UNIT], axis=-1)
    networks = RadialNetworks(torch.from_numpy(centres), float(options["width"]))
    return RadialNetworkLearner(networks, float(options["rate"]))
