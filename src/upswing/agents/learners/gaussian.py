"""A network that maps states to accelerations (§3.3): a Gaussian policy within the task's range.

The actor's single output is the mean μ(s), in units of the largest acceleration. An acceleration a of
the task has a probability in proportion to exp(−(a − μ)² / 2σ²). That is the Gaussian distribution
within their range, on as fine a set of accelerations as the task has: a run stores which of them it
took, so they are no continuum. The critic is that of ``softmax``, and so is an update.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from upswing.agents.learners import (
    Array,
    Beginning,
    Learner,
    choose_of,
    state_value_of,
    update,
    update_of,
    values,
    values_of,
)
from upswing.agents.learners.softmax import actor_of, critic_of, learned_by
from upswing.agents.policy import Q, Rule, drawn, epsilon_greedy, softmax
from upswing.physics.jit import inlined, with_item
from upswing.study.actor import ActorOptions
from upswing.study.values import Positive


class Options(ActorOptions):
    """Those of an actor and a critic, and the width of the Gaussian."""

    width: Positive = Field(
        default=3.0, description="σ, how far accelerations scatter around their mean [m/s²]."
    )

    def in_words(self) -> str:
        """For a reader of the page."""
        return (
            f"{self.made_of()} that answer with a mean acceleration, around which one is drawn with a "
            f"standard deviation of {self.width:g} m/s², and a critic of the same kind"
        )


class Gaussian(NamedTuple):
    """The actor and the critic that the loop steps."""

    actor: Any  # with μ(s) / unit
    critic: Any  # with V(s)
    rate: float
    width: float  # σ [m/s²]
    unit: float  # the largest acceleration [m/s²]
    accelerations: tuple[float, ...]  # of the actions [m/s²]


@inlined
def mean(policy: Gaussian, place: Any) -> float:
    """μ(s) [m/s²]."""
    return policy.unit * values(policy.actor, place)[0]


@values_of(Gaussian)
def _values(policy: Gaussian, place: Any) -> Q:
    middle = mean(policy, place)
    q = policy.accelerations
    for action in range(len(q)):
        away = (policy.accelerations[action] - middle) / policy.width
        q = with_item(q, action, -0.5 * away * away)
    return q


@state_value_of(Gaussian)
def _state_value(policy: Gaussian, place: Any) -> float:
    return values(policy.critic, place)[0]


@choose_of(Gaussian)
def _choose(_policy: Gaussian, q: Q, rule: Rule, draw: float) -> int:
    if rule.step_size == 0.0:  # it is tried out
        return epsilon_greedy(q, 0.0, rule.random_ties, draw)
    return drawn(softmax(q), draw)


@update_of(Gaussian)
def _update(policy: Gaussian, place: Any, action: int, error: float) -> None:
    shares = softmax(values(policy, place))
    # ∂ ln π(a|s) / ∂μ = (a − E[a]) / σ²
    surplus = policy.accelerations[action]
    for other in range(len(shares)):
        surplus -= shares[other] * policy.accelerations[other]
    slope = policy.unit * surplus / (policy.width * policy.width)
    update(policy.actor, place, 0, policy.rate * error * slope)
    update(policy.critic, place, 0, error)


class GaussianLearner:
    """The two outside the loop."""

    epsilon = None

    def __init__(
        self, actor: Learner, critic: Learner, rate: float, width: float, of: tuple[float, ...]
    ) -> None:
        self.actor, self.critic = actor, critic
        unit = max(map(abs, of))
        self.stepped = Gaussian(actor.stepped, critic.stepped, rate, width, unit, tuple(of))

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """What both learned, its names beginning with ``actor.`` and ``critic.``."""
        return learned_by(self.actor, self.critic)

    def action_values(self, places: Sequence[Any]) -> Array:
        """The logarithm of each acceleration's probability, but for a number that all share."""
        policy = self.stepped
        means = policy.unit * self.actor.action_values(places)
        values: Array = -0.5 * ((np.array(policy.accelerations) - means) / policy.width) ** 2
        return values


def create(beginning: Beginning) -> GaussianLearner:
    """An actor and a critic with one output each, drawn in this order."""
    options = beginning.options
    actor, critic = actor_of(beginning, 1), critic_of(beginning)
    return GaussianLearner(
        actor, critic, float(options["rate"]), float(options["width"]), beginning.accelerations
    )
