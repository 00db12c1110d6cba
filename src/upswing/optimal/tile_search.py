"""A search for the best policy on the thesis's own tiles.

A lower bound of what the tiles allow: it tries, and ends with its budget, so there may be better ones.
But where it finds one that does the task, the tiles can represent it.
"""

from typing import Any, NamedTuple

import numpy as np

from upswing.agents.features import locate
from upswing.agents.features.grid import Tiles
from upswing.optimal.policies import act
from upswing.optimal.tile_policy import Actions, Score, Visits, score, thesis_tiles
from upswing.physics.environment import empty_trajectory
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.runs.simulation import prepare
from upswing.study.architecture import architecture_named
from upswing.study.readings import Readings
from upswing.study.spec import Spec
from upswing.study.task import task_named

TOGETHER = 4
"""Largest number of tiles that are changed at a time."""

PERFECT: dict[str, Score] = {"balancing": (1.0, 1.0), "full-control": (1.0, 0.0)}
"""Nothing scores more than this."""

SAMPLES = 24
"""Number of angles, and of velocities, of a tile that vote for its action."""


class Found(NamedTuple):
    """What a search has found."""

    actions: Actions
    score: Score


def search(kind: str, body: Pendulum, begun: Actions, seed: int, budget: int) -> Found:
    """Change one to four tiles at a time, at random, and keep what is no worse; ``budget`` times.

    Only tiles that the policy comes to are changed: the others make no difference. It ends early
    where nothing is left to gain. Never worse than ``begun``; the same for the same ``seed``.
    """
    generator, actions = np.random.default_rng(seed), len(body.accelerations)
    visits: Visits = np.zeros(len(begun), dtype=np.int64)
    best = Found(begun.copy(), score(kind, body, begun, visits))
    visited = np.flatnonzero(visits)
    for _ in range(budget):
        if best.score >= PERFECT[kind]:
            break
        changed = best.actions.copy()
        count = 1 if generator.random() < 0.5 else int(generator.integers(2, TOGETHER + 1))
        for tile in generator.choice(visited, size=min(count, len(visited)), replace=False):
            changed[tile] = (changed[tile] + generator.integers(1, actions)) % actions
        visits[:] = 0
        scored = score(kind, body, changed, visits)
        if scored >= best.score:
            best, visited = Found(changed, scored), np.flatnonzero(visits)
    return best


def projected(kind: str, body: Pendulum, policy: Any) -> Actions:
    """What ``policy`` does most often within each tile; of equally frequent actions the first."""
    tiles = thesis_tiles(kind)
    votes = np.zeros((tiles.tiles, len(body.accelerations)), dtype=np.int64)
    rows, columns, limit, fastest = tiles.picture
    angles = (np.arange(rows * SAMPLES) + 0.5) / (rows * SAMPLES) * 2 * limit - limit
    share = (np.arange(columns * SAMPLES) + 0.5) / (columns * SAMPLES)
    _vote(policy, body, tiles, angles, share * 2 * fastest - fastest, votes)
    actions: Actions = votes.argmax(axis=1).astype(np.int8)
    return actions


def learned(kind: str, alpha: float, seed: int, steps: int) -> Actions:
    """What a table of the thesis does greedily after a number of steps of Q-learning."""
    spec = Spec(
        task=task_named(kind, kind=kind, steps=steps),
        architecture=architecture_named("table", learner="table"),
        alpha=alpha,
        seeds=(seed,),
        epsilon=0.01,
        discount=0.7,
        readings=Readings(),
    )
    setting = prepare(spec, seed)
    setting.advance(empty_trajectory(steps), 0, steps)
    table = setting.learner.learned["q"][0]
    actions: Actions = table.argmax(axis=1).astype(np.int8)
    return actions


@compiled
def _vote(
    policy: Any, body: Pendulum, tiles: Tiles, angles: Any, velocities: Any, votes: Visits
) -> None:
    for angle in angles:
        for velocity in velocities:
            tile = locate(tiles, angle, velocity).tiles[0]
            votes[tile, act(policy, body, angle, velocity)] += 1
