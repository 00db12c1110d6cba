"""The controls: no learning, always the same way of acting (C7)."""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from upswing.agents.learners import Array, Beginning, update_of, values_of
from upswing.agents.policy import Q
from upswing.physics.jit import with_item
from upswing.study import architecture
from upswing.study.task import Task


class Options(architecture.Architecture):
    """What it does."""

    learns: ClassVar[bool] = False
    behaviour: Literal["idle", "random", "push"] = Field(
        description="What a control does: always 0, any action, or always the last one."
    )

    def in_words(self) -> str:
        """For a reader of the page."""
        return {
            "idle": "no control: the cart never moves",
            "random": "every action at random",
            "push": "the cart is pushed one way for ever",
        }[self.behaviour]

    def check(self) -> None:
        """Nothing is learned, by one or by two."""
        if self.is_modular:
            raise ValueError("a control has nothing to divide into modules")

    def check_with(self, task: Task) -> None:
        """No control is an action of its own."""
        if self.behaviour == "idle" and 0 not in task.pendulum.accelerations:
            raise ValueError("`behaviour: idle` needs an action of 0 m/s² in `accelerations`")


class Control(NamedTuple):
    """Fixed values, the same in every state."""

    preference: Array  # (actions,)
    zeros: Q  # as many as there are actions


@values_of(Control)
def _values(control: Control, place: Any) -> Q:
    q = control.zeros
    for action in range(len(q)):
        q = with_item(q, action, control.preference[action])
    return q


@update_of(Control)
def _update(control: Control, place: Any, action: int, error: float) -> None:
    pass


class ControlLearner:
    """`idle` never accelerates the cart; `random` takes every action equally often; `push` the last."""

    def __init__(self, behaviour: str, accelerations: tuple[float, ...]) -> None:
        self.epsilon = 1.0 if behaviour == "random" else 0.0
        pushes = np.array(accelerations)
        preference = pushes if behaviour == "push" else -np.abs(pushes)
        self.stepped = Control(preference, (0.0,) * len(pushes))

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """Nothing is learned; ``preference`` is what the control began and ended with."""
        return {"preference": self.stepped.preference}

    def action_values(self, places: Sequence[Any]) -> Array:
        """The preference, the same in every state."""
        preference = self.stepped.preference
        return np.broadcast_to(preference, (len(places), len(preference)))


def create(beginning: Beginning) -> ControlLearner:
    """The control that the option ``behaviour`` names."""
    return ControlLearner(beginning.options["behaviour"], beginning.accelerations)
