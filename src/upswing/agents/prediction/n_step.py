"""n-step TD: n rewards that were met, and then what the state after them is thought to be worth.

With n = 1 it is TD(0); with n beyond the longest episode its targets are those of Monte Carlo (Sutton
and Barto, §7.1).
"""

from typing import NamedTuple

from upswing.agents.prediction import (
    ENDED,
    Estimate,
    Experience,
    StepSize,
    learn_of,
    move,
    nothing_known,
    value_of,
)


class NStep(NamedTuple):
    """n-step temporal difference learning."""

    estimate: Estimate
    steps: int  # n


@learn_of(NStep)
def _learn(method: NStep, experience: Experience, discount: float, t: int) -> None:
    """V(s) ← V(s) + α [r₁ + γ r₂ + … + γⁿ⁻¹ rₙ + γⁿ V(s⁽ⁿ⁾) − V(s)] for the state n − 1 steps ago.

    Where the episode ends, so do the rewards of all states that still wait for theirs.
    """
    oldest = t + 1 - method.steps
    newest = t if experience.after[t] == ENDED else oldest
    for visit in range(max(oldest, experience.begun[t]), newest + 1):
        target = value_of(method.estimate, experience.after[t])
        for back in range(t, visit - 1, -1):
            target = experience.reward[back] + discount * target
        move(method.estimate, experience.tile[visit], target)


def create(tiles: int, step_size: StepSize, steps: int) -> NStep:
    """n-step TD with n = ``steps``, before its first step."""
    return NStep(nothing_known(tiles, step_size), steps)
