"""The options of a learner that is a controller: a law from control theory, which learns nothing."""

from typing import ClassVar

from upswing.study.architecture import Architecture, Features


class ControllerOptions(Architecture):
    """It is told the state as it is, and never acts at random."""

    takes: ClassVar[tuple[Features, ...]] = ("state",)
    learns: ClassVar[bool] = False

    def epsilon_in(self, _study: float) -> float:
        """No share of its actions is random, whatever a study has."""
        return 0.0

    def check(self) -> None:
        """So it takes no ε of its own."""
        if self.epsilon:
            raise ValueError(f"{self.learner} never acts at random; leave `epsilon` out")
