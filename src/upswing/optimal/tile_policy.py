"""A policy on the thesis's own tiles, one action for each of them, and how good it is."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import locate
from upswing.agents.features.grid import Tiles, tiles_for
from upswing.optimal.policies import act_of
from upswing.optimal.state_grid import step
from upswing.physics import tasks
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL
from upswing.runs.metrics import UPRIGHT
from upswing.study.readings import Readings
from upswing.study.task import kind_of_task

Actions = NDArray[np.int8]
"""An action for each tile, shape (tiles,), indices into the body's accelerations."""

Visits = NDArray[np.int64]
Score = tuple[float, float]
"""What is made as large as possible, and what decides between two that are equally large."""

BALANCED = 50_000
"""Largest number of steps that a start is followed when balancing: the length of a run of the study."""


class TilePolicy(NamedTuple):
    """One action for each tile."""

    tiles: Tiles
    actions: Actions


@act_of(TilePolicy)
def _act(policy: TilePolicy, body: Pendulum, angle: float, angular_velocity: float) -> int:
    return int(policy.actions[locate(policy.tiles, angle, angular_velocity).tiles[0]])


def thesis_tiles(kind: str) -> Tiles:
    """The tiles of one table: 80 when balancing, 160 for full control (§4.5.1, §4.6.1)."""
    return tiles_for(tasks.create(kind, Readings()), False, Readings())


def score(kind: str, body: Pendulum, actions: Actions, visits: Visits) -> Score:
    """What a policy on the tiles comes to, from the starts of the study's greedy evaluation.

    Full control: the share of the last 1,000 of 4,000 steps that is upright, then the mean reward of
    those [rad²]. Balancing: the steps until it falls, at most 50,000, as a share of them, averaged over
    the starts; then the same of the worst start. ``visits``, shape (tiles,), is raised where it came.
    """
    policy = TilePolicy(thesis_tiles(kind), actions)
    task = kind_of_task(kind)
    starts = np.array(task.greedy_starts)
    if task.judged_by == "falls":
        return _until_falls(policy, body, starts, BALANCED, visits)
    return _at_the_end(policy, body, starts, task.greedy_steps, task.greedy_judged, visits)


@compiled
def _at_the_end(
    policy: TilePolicy,
    body: Pendulum,
    starts: NDArray[np.float64],
    steps: int,
    judged: int,
    visits: Visits,
) -> Score:
    upright, rewards = 0, 0.0
    for start in starts:
        angle, angular_velocity = start, 0.0
        for t in range(steps):
            tile = locate(policy.tiles, angle, angular_velocity).tiles[0]
            visits[tile] += 1
            upright += t >= steps - judged and abs(angle) <= UPRIGHT
            angle, angular_velocity = step(body, angle, angular_velocity, int(policy.actions[tile]))
            if t >= steps - judged:
                rewards -= angle * angle
    judgements = judged * len(starts)
    return upright / judgements, rewards / judgements


@compiled
def _until_falls(
    policy: TilePolicy,
    body: Pendulum,
    starts: NDArray[np.float64],
    steps: int,
    visits: Visits,
) -> Score:
    survived, worst = 0, steps
    for start in starts:
        angle, angular_velocity = start, 0.0
        lasted = steps
        for t in range(steps):
            tile = locate(policy.tiles, angle, angular_velocity).tiles[0]
            visits[tile] += 1
            angle, angular_velocity = step(body, angle, angular_velocity, int(policy.actions[tile]))
            if abs(angle) > HORIZONTAL:
                lasted = t + 1
                break
        survived += lasted
        worst = min(worst, lasted)
    return survived / (steps * len(starts)), worst / steps
