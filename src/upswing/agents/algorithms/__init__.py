"""Algorithms: what is learned from a step, and when (§2.4, §3.1).

An algorithm is a named tuple of arrays (empty if nothing is remembered), so that the loop can step it in
place. Its file gives a body to ``learn_from``, to the other two functions where it needs them, and has a
function ``create`` that makes one for a run. Algorithms are imported by name, as learners are.

The readings R13 (``bootstrap_sign``) and R14 (``hand_over``) are about the thesis's own algorithm;
others need not know them. Of a step that fell and is not terminal, s′ is the fallen state (R7): it has a
place, and no action is ever taken in it.
"""

from collections.abc import Mapping
from math import nan
from typing import Any, NamedTuple

import numpy as np

from upswing.agents.features import Encoder
from upswing.agents.policy import Q, Rule
from upswing.physics.jit import ByType
from upswing.physics.pendulum import Pendulum
from upswing.study.loading import load
from upswing.study.readings import Readings


class Step(NamedTuple):
    """What happened in a step."""

    t: int
    angle: float  # φ of s [rad]
    angular_velocity: float  # φ̇ of s [rad/s]
    place: Any  # of s in the encoder
    q: Q  # Q(s, ·)
    action: int  # a
    reward: float  # r, in R3's unit, with all that a learner is told
    next_place: Any  # of s′
    fell: bool  # whether s′ is where an episode of balancing ends
    terminal: bool  # whether nothing follows s′ (R7)


def _before_choice(
    algorithm: Any, encoder: Any, learner: Any, rule: Rule, td_errors: Any, place: Any
) -> None:
    """What can be learned on arriving in a state, before an action is chosen there."""


def _after_choice(
    algorithm: Any, encoder: Any, learner: Any, rule: Rule, td_errors: Any, place: Any, action: int
) -> None:
    """What can be learned once an action has been chosen, before it is taken."""


def _learn_from(
    algorithm: Any, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    """Learn from a step; δ in R3's unit, NaN if its update comes later.

    An update that comes later puts its δ [rad²] into ``td_errors``, at the step it belongs to.
    """
    return nan


_before_choice_by_type = ByType(_before_choice)
_after_choice_by_type = ByType(_after_choice)
_learn_from_by_type = ByType(_learn_from)

before_choice = _before_choice_by_type.call
after_choice = _after_choice_by_type.call
learn_from = _learn_from_by_type.call
before_choice_of = _before_choice_by_type.register
after_choice_of = _after_choice_by_type.register
learn_from_of = _learn_from_by_type.register

Q_LEARNING = "q-learning"
"""The algorithm of the thesis."""


class Design(NamedTuple):
    """What an algorithm is made from."""

    encoder: Encoder  # the feature encoder: how many tiles and modules there are
    discount: float  # γ
    options: Mapping[str, Any]  # of the architecture
    readings: Readings
    draws: np.random.Generator  # the algorithm's own stream of random numbers
    actions: int = len(Pendulum().accelerations)
    learner: Any = None  # as the loop steps it


def create(name: str, design: Design) -> NamedTuple:
    """An algorithm, by the name of its file in this folder, with nothing remembered."""
    algorithm: NamedTuple = load("algorithms", name).create(design)
    if type(algorithm) not in _learn_from_by_type.bodies:
        raise TypeError(
            f"algorithm {name}: no body under @learn_from_of({type(algorithm).__name__})"
        )
    return algorithm
