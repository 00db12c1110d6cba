"""A specification and a seed → everything that the loop needs for a run."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from upswing import loop
from upswing.learners import Beginning, Learner, create
from upswing.pendulum import FROM_HANGING, FROM_UPRIGHT, Pendulum
from upswing.spec import Spec
from upswing.tasks import KINDS, Task, start
from upswing.tiles import Tiles, tiles_for

REWARD_SCALES = {"half_turn": 4.0, "radians": 1.0, "degrees": (180 / np.pi) ** 2}
"""From rad² into the unit of R3; half_turn reads 90° as π, so an angle is twice its radians."""

RESETS = {
    "fallen": loop.RESET_FALLEN,
    "terminal": loop.RESET_TERMINAL,
    "reset": loop.RESET_START,
}
HAND_OVERS = {"owner": loop.OWNER, "own": loop.OWN, "terminal": loop.TERMINAL}


def streams(seed: int) -> Iterator[np.random.Generator]:
    """The streams of random numbers of a run, from its seed alone.

    In order: actions, starts, first weights, greedy evaluation. Runs of different cells with the
    same seed so see the same draws.
    """
    return (np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(4))


@dataclass
class Setting:
    """A run in the making."""

    body: Pendulum
    task: Task
    tiles: Tiles
    rule: loop.Rule
    learner: Learner
    state: loop.State
    left_open: loop.Open
    actions: np.random.Generator
    starts: np.random.Generator

    def advance(self, trajectory: loop.Trajectory, first: int, last: int) -> None:
        """Go on from step ``first`` up to ``last``, recorded in ``trajectory``."""
        self.state = loop.learn(
            self.body,
            self.task,
            self.tiles,
            self.learner.stepped,
            self.rule,
            self.state,
            self.left_open,
            self.actions,
            self.starts,
            trajectory,
            first,
            last,
        )


def body_of(spec: Spec) -> Pendulum:
    """The pendulum under the reading R1."""
    upright = spec.readings.zero_of_angle == "upright"
    return Pendulum(orientation=FROM_UPRIGHT if upright else FROM_HANGING)


def prepare(spec: Spec, seed: int) -> Setting:
    """A run of ``spec`` before its first step."""
    readings, settings = spec.readings, spec.architecture
    actions, starts, weights, _ = streams(seed)
    task = KINDS[spec.task.kind](readings)
    tiles = tiles_for(spec.task.kind, settings.modular, readings)
    scale = REWARD_SCALES[readings.reward_unit]
    learner = create(
        settings.learner,
        Beginning(
            tiles=tiles,
            hidden=settings.hidden,
            behaviour=settings.behaviour or "",
            readings=readings,
            lowest_q=-scale * task.largest_angle**2 / (1 - spec.discount),
            weights=weights,
        ),
    )
    printed_error = settings.learner == "networks" and readings.error_sign == "printed"
    rule = loop.Rule(
        step_size=0.0 if spec.alpha is None else float(spec.alpha),
        discount=float(spec.discount),
        bootstrap_sign=-1.0 if printed_error else 1.0,
        reward_scale=scale,
        epsilon=float(spec.epsilon) if learner.epsilon is None else learner.epsilon,
        random_ties=readings.ties == "random",
        reset=RESETS[readings.reset],
        hand_over=HAND_OVERS[readings.hand_over],
    )
    return Setting(
        body=body_of(spec),
        task=task,
        tiles=tiles,
        rule=rule,
        learner=learner,
        state=loop.State(*start(task, starts), 0.0, 0.0),
        left_open=loop.nothing_open(tiles.modules),
        actions=actions,
        starts=starts,
    )
