"""An architecture as it is configured: a learner, a feature encoder and an algorithm.

Each of the three is a file; its options, and what it goes with, stand there in a class ``Options``.
"""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, SerializeAsAny, model_validator

from upswing.study.declared import Family, part_name, part_schema
from upswing.study.names import Name
from upswing.study.task import Task
from upswing.study.values import Discount, Share, Strict

Features = Literal["tile", "tiles", "activations", "state"]
"""What a feature encoder says of a state.

The tile that it lies in, several that overlap, a number for each feature, or (φ, φ̇) as it is.
"""

Content = Literal["values", "policy"]
"""What a learner holds: the values of actions, or a map from states to actions (§3.3)."""


class Architecture(Strict):
    """What learns, and from what (§4.4–4.6)."""

    learner: Annotated[str, part_name("learners"), part_schema("learners")] = Field(
        description="What holds Q; a file in src/upswing/agents/learners."
    )
    coding: Annotated[str, part_name("features"), part_schema("features")] = Field(
        default="grid",
        description="The feature encoder: what the learner is told of a state; a file in "
        "src/upswing/agents/features.",
    )
    method: Annotated[str, part_name("algorithms"), part_schema("algorithms")] = Field(
        default="q-learning",
        description="The algorithm: how it learns from a step; a file in "
        "src/upswing/agents/algorithms.",
    )
    epsilon: Share | None = Field(default=None, description="Its own ε in place of the study's.")
    discount: Discount | None = Field(
        default=None, description="Its own γ in place of the study's."
    )

    takes: ClassVar[tuple[Features, ...]] = ("tile", "tiles", "activations", "state")
    """What a learner can learn from."""

    gives: ClassVar[Features] = "tile"
    """What a feature encoder gives."""

    computes_with: ClassVar[tuple[str, ...]] = ()
    """Distributions whose version may change a run, besides those that every run computes with."""

    holds: ClassVar[Content] = "values"
    """What a learner holds."""

    improves: ClassVar[Content] = "values"
    """What an algorithm improves."""

    learns: ClassVar[bool] = True
    """Whether there is anything to learn, and so a step size α."""

    def check(self) -> None:
        """Raise ``ValueError`` if what is chosen does not go together; each part checks its own."""

    def check_with(self, task: Task) -> None:
        """Raise ``ValueError`` if it does not go with a task; each part checks its own."""

    def epsilon_in(self, study: float) -> float:
        """The share of random actions in a study that has ``study``; a policy explores by itself."""
        if self.holds == "policy":
            return 0.0
        return study if self.epsilon is None else self.epsilon

    def misfits(self, task: Task) -> Iterator[str]:
        """Why it does not go with a task, by each part that says so."""
        for part in type(self).__mro__:
            if "check_with" in vars(part):
                try:
                    part.check_with(self, task)  # type: ignore[attr-defined]
                except ValueError as error:
                    yield str(error)

    def inner_learners(self) -> tuple[str, ...]:
        """The learners that the learner is made of, by name."""
        return ()

    def in_words(self) -> str:
        """What the learner is, for a reader of the page."""
        return f"the learner {self.learner}"

    @property
    def is_modular(self) -> bool:
        """Whether two modules share the grid of the thesis (§4.6.3)."""
        return bool(getattr(self, "modular", False))

    @model_validator(mode="after")
    def _goes_together(self) -> Self:
        if self.gives not in self.takes:
            raise ValueError(
                f"`coding: {self.coding}` gives {MEANING[self.gives]}; {self.learner} takes "
                f"{' or '.join(MEANING[features] for features in self.takes)}"
            )
        if self.holds != self.improves:
            raise ValueError(
                f"`method: {self.method}` improves {HELD[self.improves]}; {self.learner} holds "
                f"{HELD[self.holds]}"
            )
        if self.holds == "policy" and self.epsilon:
            raise ValueError(
                f"{self.learner} draws its actions by probabilities of its own; leave `epsilon` out"
            )
        for part in type(self).__mro__:
            if "check" in vars(part):
                part.check(self)  # type: ignore[attr-defined]
        return self


MEANING: dict[Features, str] = {
    "tile": "one tile",
    "tiles": "several tiles at once",
    "activations": "a number for each feature",
    "state": "the state itself",
}

HELD: dict[Content, str] = {"values": "values of actions", "policy": "a policy"}


class NamedArchitecture(Architecture):
    """An architecture and the name it has in the study."""

    name: Name


ARCHITECTURES = Family(
    Architecture, {"learner": "learners", "coding": "features", "method": "algorithms"}
)
AnyArchitecture = Annotated[SerializeAsAny[Architecture], ARCHITECTURES.chooser(Architecture)]
AnyNamedArchitecture = Annotated[
    SerializeAsAny[NamedArchitecture], ARCHITECTURES.chooser(NamedArchitecture)
]


def architecture_of(**keys: Any) -> Architecture:
    """An architecture with the options of its parts."""
    return ARCHITECTURES.make(Architecture, keys)


def architecture_named(name: str, **keys: Any) -> NamedArchitecture:
    """The same with a name."""
    return ARCHITECTURES.make(NamedArchitecture, {"name": name, **keys})
