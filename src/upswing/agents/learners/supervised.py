"""The thesis's networks, taught by a controller before a run begins: supervised learning (§1, §4.1).

The examples are pairs of a state and the action that the controller takes there. Backpropagation fits
the networks to them, in mini-batches: the action that was taken shall be worth 0, the others ``margin``
less. 0 is the most that a return can be here, every reward being −φ²; so Q-learning can go on from what
was taught, and tries another action where the taught one proves to be worth less than that.

torch computes the gradients and learns. A run is the same again on the same machine; torch's sums may
differ from processor to processor.
"""

from collections.abc import Iterator
from typing import ClassVar, Literal

import numpy as np
import torch
from numpy.typing import NDArray
from pydantic import Field
from torch import Tensor

from upswing.agents.features import Point, locate
from upswing.agents.learners import Beginning, networks, values
from upswing.agents.learners.backpropagation.dense import inputs
from upswing.agents.learners.networks import NetworksLearner, QNetworks
from upswing.study import architecture
from upswing.study.loading import load
from upswing.study.values import Count, LayerSizes, Positive

Actions = NDArray[np.int64]


class Options(architecture.Architecture):
    """The networks, their teacher and their lessons."""

    takes: ClassVar[tuple[architecture.Features, ...]] = ("tile", "state")
    computes_with: ClassVar[tuple[str, ...]] = ("scipy",)  # a teacher does
    hidden: LayerSizes = Field(
        min_length=1,
        description="Numbers of units of one or two hidden layers, input side first.",
    )
    teacher: Literal["fuzzy", "energy-lqr"] = Field(
        default="fuzzy", description="The controller that is learned from, as its defaults make it."
    )
    pairs: Count = Field(
        default=4_000, description="Number of examples, a state and the teacher's action there."
    )
    epochs: Count = Field(default=30, description="How often the networks see each example.")
    batch_size: Count = Field(
        default=100, description="Number of examples that are learned from at once."
    )
    lesson_rate: Positive = Field(
        default=0.03, description="Adam's step size while the networks are taught."
    )
    margin: Positive = Field(
        default=1.0, description="How much less an action is worth that the teacher did not take."
    )

    def inner_learners(self) -> tuple[str, ...]:
        """The networks and their teacher."""
        return ("networks", self.teacher)

    def in_words(self) -> str:
        """For a reader of the page."""
        units = " and ".join(map(str, self.hidden))
        return (
            f"networks with {units} logistic hidden units, taught beforehand by {self.pairs:,} examples "
            f"of what the controller {self.teacher} does"
        )

    def check(self) -> None:
        """There is one hidden layer where the state itself goes in."""
        if self.gives == "state" and len(self.hidden) > 1:
            raise ValueError("`hidden` has one size here: there is one hidden layer")


def examples(beginning: Beginning) -> tuple[list[Point], Actions]:
    """States and the teacher's action in each: uniform over what a picture of the task shows."""
    name = beginning.options["teacher"]
    told = architecture.architecture_of(learner=name, coding="continuous").model_dump()
    teacher = load("learners", name).create(beginning._replace(options=told))
    seen, count = beginning.encoder.picture, beginning.options["pairs"]
    angles = beginning.weights.uniform(-seen.angle_limit, seen.angle_limit, count)
    velocities = beginning.weights.uniform(-seen.velocity_limit, seen.velocity_limit, count)
    states = [Point(0, *state) for state in zip(angles.tolist(), velocities.tolist(), strict=True)]
    return states, np.array([np.argmax(values(teacher.stepped, state)) for state in states])


def targets(actions: Actions, count: int, margin: float) -> Tensor:
    """What each of ``count`` actions shall be worth: (examples, count)."""
    wanted = torch.full((len(actions), count), -margin, dtype=torch.float64)
    wanted[torch.arange(len(actions)), torch.from_numpy(actions)] = 0.0
    return wanted


def batches(
    draws: np.random.Generator, count: int, size: int, epochs: int
) -> Iterator[NDArray[np.int64]]:
    """The examples of each mini-batch: in every epoch all of them, in an order of its own."""
    for _ in range(epochs):
        order = draws.permutation(count)
        yield from (order[first : first + size] for first in range(0, count, size))


def taught(
    model: QNetworks, modules: Tensor, states: Tensor, wanted: Tensor, beginning: Beginning
) -> None:
    """Fit networks to ``wanted`` (examples, actions) by the mean squared error.

    Args:
        model: the networks, changed in place.
        modules: the module of each example, (examples,).
        states: what the networks are told of it, (examples, inputs).
        wanted: what its actions shall be worth.
        beginning: the lessons, and the stream of their order.
    """
    options = beginning.options
    torch.set_num_threads(1)  # the matrices are small
    optimiser = torch.optim.Adam(model.parameters(), lr=options["lesson_rate"])
    count = beginning.encoder.modules
    for batch in batches(beginning.weights, len(states), options["batch_size"], options["epochs"]):
        chosen = torch.from_numpy(batch)
        told, place = states[chosen], torch.arange(len(chosen))
        answers = torch.stack([model(module, told) for module in range(count)])
        error = torch.mean((answers[modules[chosen], place] - wanted[chosen]) ** 2)
        optimiser.zero_grad()
        error.backward()  # type: ignore[no-untyped-call]
        optimiser.step()


def create(beginning: Beginning) -> NetworksLearner:
    """The networks of ``networks.py`` with the weights that the lessons left."""
    learner = networks.create(beginning)
    points, actions = examples(beginning)
    places = [locate(beginning.encoder, s.angle, s.angular_velocity) for s in points]
    if learner.tiled:
        tiles = torch.tensor([place.tiles[0] for place in places])
        states = torch.eye(beginning.encoder.tiles, dtype=torch.float64)[tiles]
    else:
        states = torch.tensor([inputs(point) for point in places], dtype=torch.float64)
    modules = torch.tensor([place.module for place in places])
    wanted = targets(actions, beginning.actions, beginning.options["margin"])
    taught(learner.networks, modules, states, wanted, beginning)
    return learner
