"""The options of a learner that is a controller: a law from control theory, which learns nothing."""

from typing import ClassVar

from upswing.study.architecture import Architecture, Features


class ControllerOptions(Architecture):
    """It is told the state as it is, and never explores."""

    takes: ClassVar[tuple[Features, ...]] = ("state",)
    learns: ClassVar[bool] = False
