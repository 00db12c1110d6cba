"""Monte Carlo: the target of a state is the return that followed it, to the end of the episode (§2.4.3).

It does not bootstrap. Nothing is learned before an episode is over.
"""

from typing import NamedTuple

import numpy as np

from upswing.agents.prediction import (
    ENDED,
    Estimate,
    Experience,
    StepSize,
    Whole,
    learn_of,
    move,
    nothing_known,
)


class MonteCarlo(NamedTuple):
    """First-visit or every-visit Monte Carlo."""

    estimate: Estimate
    first_visit: bool  # whether only the first visit of a tile in an episode counts
    met: Whole  # the step at which each tile was first visited in its latest episode, (tiles,)


@learn_of(MonteCarlo)
def _learn(method: MonteCarlo, experience: Experience, discount: float, t: int) -> None:
    """V(s) ← V(s) + α [return − V(s)] for the visits of an episode, the last one first."""
    begun = experience.begun[t]
    if method.met[experience.tile[t]] < begun:
        method.met[experience.tile[t]] = t
    if experience.after[t] != ENDED:
        return
    return_ = 0.0
    for visit in range(t, begun - 1, -1):
        return_ = experience.reward[visit] + discount * return_
        tile = experience.tile[visit]
        if not method.first_visit or method.met[tile] == visit:
            move(method.estimate, tile, return_)


def create(tiles: int, step_size: StepSize, *, first_visit: bool) -> MonteCarlo:
    """Monte Carlo before its first step."""
    return MonteCarlo(nothing_known(tiles, step_size), first_visit, np.full(tiles, -1))
