"""A network that maps states to actions (§3.3), and no Q: each action has a probability.

The actor is networks, or a table, with a preference for each action; e to the power of it says how
likely the action is. The critic, made likewise, has a single output: V(s). An update moves both, the
critic by α·δ and the actor by ``rate``·α·δ along the gradient of ln π(a|s).
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

from numpy.typing import NDArray

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
from upswing.agents.policy import Q, Rule, softmax, softmax_choice
from upswing.study.actor import ActorOptions
from upswing.study.loading import load


class Options(ActorOptions):
    """Those of an actor and a critic."""

    def in_words(self) -> str:
        """For a reader of the page."""
        return (
            f"{self.made_of()} that answer with a probability for each action, and a critic of the same "
            "kind that says how good a state is"
        )


class Softmax(NamedTuple):
    """The actor and the critic that the loop steps."""

    actor: Any  # with a preference for each action
    critic: Any  # with V(s)
    rate: float


@values_of(Softmax)
def _values(policy: Softmax, place: Any) -> Q:
    return values(policy.actor, place)


@state_value_of(Softmax)
def _state_value(policy: Softmax, place: Any) -> float:
    return values(policy.critic, place)[0]


@choose_of(Softmax)
def _choose(_policy: Softmax, q: Q, rule: Rule, draw: float) -> int:
    return softmax_choice(q, rule, draw)


@update_of(Softmax)
def _update(policy: Softmax, place: Any, action: int, error: float) -> None:
    shares = softmax(values(policy.actor, place))
    for other in range(len(shares)):  # ∂ ln π(a|s) / ∂ preference(b) = [a = b] − π(b|s)
        slope = (1.0 if other == action else 0.0) - shares[other]
        update(policy.actor, place, other, policy.rate * error * slope)
    update(policy.critic, place, 0, error)


class SoftmaxLearner:
    """The two outside the loop."""

    epsilon = None

    def __init__(self, actor: Learner, critic: Learner, rate: float) -> None:
        self.actor, self.critic = actor, critic
        self.stepped = Softmax(actor.stepped, critic.stepped, rate)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """What both learned, its names beginning with ``actor.`` and ``critic.``."""
        return learned_by(self.actor, self.critic)

    def action_values(self, places: Sequence[Any]) -> Array:
        """The actor's preferences."""
        return self.actor.action_values(places)


def learned_by(actor: Learner, critic: Learner) -> Mapping[str, NDArray[Any]]:
    """What an actor and a critic learned, by name."""
    return {
        f"{part}.{name}": array
        for part, learner in (("actor", actor), ("critic", critic))
        for name, array in learner.learned.items()
    }


def actor_of(beginning: Beginning, outputs: int) -> Learner:
    """Networks with ``hidden`` layers, or tables of zero where there are none, with so many outputs.

    R5 is about a first Q, and this is none.
    """
    return _part(beginning._replace(lowest_q=0.0), outputs)


def critic_of(beginning: Beginning) -> Learner:
    """The same with one output, V(s); a table begins as R5 says of Q."""
    return _part(beginning, 1)


def _part(beginning: Beginning, outputs: int) -> Learner:
    name = ActorOptions.part(beginning.options["hidden"])
    plan = beginning._replace(body=beginning.body._replace(accelerations=(0.0,) * outputs))
    learner: Learner = load("learners", name).create(plan)
    return learner


def create(beginning: Beginning) -> SoftmaxLearner:
    """An actor with an output for each action and a critic with one, drawn in this order."""
    actor, critic = actor_of(beginning, beginning.actions), critic_of(beginning)
    return SoftmaxLearner(actor, critic, float(beginning.options["rate"]))
