"""TD(0): the target of a state is its reward and what the next state is thought to be worth (§2.4.4)."""

from typing import NamedTuple

from upswing.agents.prediction import (
    Estimate,
    Experience,
    StepSize,
    learn_of,
    move,
    nothing_known,
    value_of,
)


class TD0(NamedTuple):
    """One-step temporal difference learning."""

    estimate: Estimate


@learn_of(TD0)
def _learn(method: TD0, experience: Experience, discount: float, t: int) -> None:
    """V(s) ← V(s) + α [r + γ V(s′) − V(s)]."""
    target = experience.reward[t] + discount * value_of(method.estimate, experience.after[t])
    move(method.estimate, experience.tile[t], target)


def create(tiles: int, step_size: StepSize) -> TD0:
    """TD(0) before its first step."""
    return TD0(nothing_known(tiles, step_size))
