"""The options of a learner that is an actor, which holds a policy, and a critic, which judges it."""

from typing import ClassVar

from pydantic import Field

from upswing.study.architecture import Architecture, Content
from upswing.study.values import LayerSizes, Positive


class ActorOptions(Architecture):
    """What the actor and the critic are."""

    holds: ClassVar[Content] = "policy"
    hidden: LayerSizes = Field(
        default=(),
        description="Numbers of units of the hidden layers of actor and critic; none for tables.",
    )
    rate: Positive = Field(
        default=1.0, description="The step size of the actor, as a multiple of the critic's α."
    )

    @staticmethod
    def part(hidden: tuple[int, ...]) -> str:
        """The learner that actor and critic are, by name."""
        return "networks" if hidden else "table"

    def inner_learners(self) -> tuple[str, ...]:
        """The learner of actor and critic."""
        return (type(self).part(self.hidden),)

    def made_of(self) -> str:
        """What they are, for a reader of the page."""
        units = " and ".join(map(str, self.hidden))
        return f"networks with {units} logistic hidden units" if units else "tables"

    def check(self) -> None:
        """Networks and tables take each their own."""
        if self.hidden and self.gives == "tiles":
            raise ValueError("networks take one tile or the state; leave `hidden` out")
        if not self.hidden and self.gives == "state":
            raise ValueError("a table takes tiles; write `hidden: [30]` for networks")
        if self.gives == "state" and len(self.hidden) > 1:
            raise ValueError("`hidden` has one size here: there is one hidden layer")
