"""No algorithm: what a learner knows when a run begins, it keeps.

For one that was taught beforehand. Such a run has no step size α, and its δ is unknown at every step.
"""

from math import nan
from typing import Any, ClassVar, NamedTuple

from upswing.agents.algorithms import Design, Step, learn_from_of
from upswing.agents.policy import Rule
from upswing.study import architecture


class Options(architecture.Architecture):
    """Nothing is learned from steps."""

    learns: ClassVar[bool] = False


class Frozen(NamedTuple):
    """Nothing to remember, in a tuple that is not empty."""

    nothing: float = nan


@learn_from_of(Frozen)
def _learn_from(
    algorithm: Frozen, encoder: Any, learner: Any, rule: Rule, td_errors: Any, step: Step
) -> float:
    return nan


def create(design: Design) -> Frozen:
    """There is only one."""
    return Frozen()
