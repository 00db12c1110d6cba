"""An agent from elsewhere as a learner that learns nothing: ``upswing adopt`` runs it in the study.

While it is being adopted, the agent itself acts. What is kept of it is a map: its action in the middle
of 120 × 120 parts of the state space. Who reads its run back gets a learner that follows the map, so
that nobody's code is run because a folder of results names it.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from math import nan
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from upswing.agents.elsewhere import Acting, Agent
from upswing.agents.features import Picture, Point
from upswing.agents.learners import Array, Beginning, update_of, values, values_of
from upswing.agents.policy import Q
from upswing.physics.environment import NEVER, State, record, transition
from upswing.physics.jit import with_item
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import Task
from upswing.study import architecture
from upswing.study.names import Text

PARTS = 120
"""Parts of φ and of φ̇ of the map: three of each to one of a recording's picture."""

UNKNOWN = -1
"""The action of a map that was not filled in."""

_acting: ContextVar[Agent | None] = ContextVar("acting", default=None)


class Options(architecture.Architecture):
    """Which agent it is; ``upswing adopt`` fills this in, and a configuration cannot name one."""

    learns: ClassVar[bool] = False
    takes: ClassVar[tuple[architecture.Features, ...]] = ("state",)
    agent: Text = Field(
        min_length=3, description="The agent as it was given: file.py:function or module:function."
    )
    checksums: dict[Text, Text] = Field(
        default={}, description="SHA-256 of the agent's file, and of the files it was said to read."
    )
    made_with: Text = Field(
        default="", description="The packages that the agent's file imports, with their versions."
    )

    def in_words(self) -> str:
        """For a reader of the page."""
        return f"an agent from elsewhere, {self.agent}"

    def check(self) -> None:
        """It has nothing of ours but the states."""
        if self.method != "q-learning":
            raise ValueError("an adopted agent has no algorithm here; leave `method` out")


class Mapped(NamedTuple):
    """The map of an agent."""

    actions: NDArray[np.int8]  # its action in each part: (parts of φ, parts of φ̇)
    angle_limit: float  # it covers ± this [rad] …
    velocity_limit: float  # … and ± this [rad/s]
    zeros: Q  # as many as there are actions


@values_of(Mapped)
def _values(mapped: Mapped, point: Point) -> Q:
    parts = mapped.actions.shape[0]
    limit, fastest = mapped.angle_limit, mapped.velocity_limit
    row = int((point.angle + limit) / (2 * limit) * parts)
    column = int((point.angular_velocity + fastest) / (2 * fastest) * parts)
    chosen = mapped.actions[max(0, min(row, parts - 1)), max(0, min(column, parts - 1))]
    q = mapped.zeros
    for action in range(len(q)):
        if action != chosen:
            q = with_item(q, action, nan if chosen < 0 else -1.0)
    return q


@update_of(Mapped)
def _update(mapped: Mapped, point: Point, action: int, error: float) -> None:
    pass


class MappedLearner:
    """What is left of an agent: it does in a state what the agent did in the middle of its part."""

    epsilon = 0.0

    def __init__(self, picture: Picture, actions: int) -> None:
        unknown = np.full((PARTS, PARTS), UNKNOWN, dtype=np.int8)
        limits = picture.angle_limit, picture.velocity_limit
        self.stepped = Mapped(unknown, *limits, zeros=(0.0,) * actions)

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """The map; nothing was learned here."""
        return {"actions": self.stepped.actions}

    def action_values(self, places: Sequence[Point]) -> Array:
        """0 for the action of the map at ``places``, −1 for the others."""
        found = [values(self.stepped, place) for place in places]
        return np.array(found, dtype=np.float64).reshape(len(places), len(self.stepped.zeros))


class ActingLearner(MappedLearner):
    """The agent itself, asked at every step."""

    def __init__(self, picture: Picture, acting: Acting) -> None:
        super().__init__(picture, len(acting.accelerations))
        self.acting = acting
        middles = (np.arange(PARTS) + 0.5) * 2 / PARTS - 1
        for row, angle in enumerate((middles * picture.angle_limit).tolist()):
            for column, velocity in enumerate((middles * picture.velocity_limit).tolist()):
                acting.begin()  # each is a beginning to an agent that remembers
                self.stepped.actions[row, column] = acting.action(angle, velocity)

    def advance(
        self, body: Pendulum, task: Task, _encoder: Any, _stepped: Mapped, _algorithm: Any, rule: Any,
        state: State, actions: np.random.Generator, starts: np.random.Generator,
        trajectory: Any, first: int, last: int,
    ) -> State:  # fmt: skip
        """What ``loop.learn`` does, without learning and with the agent's own actions.

        It draws as the loop does, so that runs of a seed stay paired where a stream is shared.
        """
        if first == 0:
            trajectory.diverged_at[0] = NEVER
            if last > 0:
                self.acting.begin()
        for t in range(first, last):
            actions.random()
            action = self.acting.action(state.angle, state.angular_velocity)
            taken = transition(body, task, rule.discount, state, action, starts)
            record(trajectory, t, state, action, taken, nan)
            state = taken.after
            if taken.fell:
                self.acting.begin()
        return state


@contextmanager
def acting(agent: Agent) -> Iterator[None]:
    """While this lasts, adopted learners are ``agent`` itself."""
    token = _acting.set(agent)
    try:
        yield
    finally:
        _acting.reset(token)


def create(beginning: Beginning) -> MappedLearner:
    """The agent that is being adopted; where none is, an empty map for what is read back."""
    picture = beginning.encoder.picture
    agent = _acting.get()
    if agent is None:
        return MappedLearner(picture, beginning.actions)
    # Each stream of a run is made from a child of the sequence that the run's seed begins.
    seed: Any = beginning.weights.bit_generator.seed_seq
    return ActingLearner(picture, Acting(agent, int(seed.entropy), beginning.accelerations))
