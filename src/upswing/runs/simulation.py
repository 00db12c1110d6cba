"""A specification and a seed → everything that the loop needs for a run."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from upswing.agents import algorithms, features, learners
from upswing.agents.features import Encoder
from upswing.agents.learners import Learner
from upswing.agents.policy import Rule
from upswing.physics import tasks
from upswing.physics.environment import State, Trajectory
from upswing.physics.pendulum import FROM_HANGING, FROM_UPRIGHT, Pendulum
from upswing.physics.pendulum import body_of as body_of
from upswing.physics.tasks import Task
from upswing.runs import loop
from upswing.study.spec import Spec

REWARD_SCALES = {"half_turn": 4.0, "radians": 1.0, "degrees": (180 / np.pi) ** 2}
"""From rad² into the unit of R3; half_turn reads 90° as π, so an angle is twice its radians."""


def streams(seed: int) -> Iterator[np.random.Generator]:
    """The streams of random numbers of a run, from its seed alone.

    In order: actions, starts, first weights, greedy evaluation, the algorithm's own draws. Runs of
    different cells with the same seed so see the same draws.
    """
    return (np.random.default_rng(child) for child in np.random.SeedSequence(seed).spawn(5))


@dataclass
class Setting:
    """A run in the making."""

    body: Pendulum
    task: Task
    encoder: Encoder
    rule: Rule
    learner: Learner
    algorithm: NamedTuple
    state: State
    actions: np.random.Generator
    starts: np.random.Generator

    def advance(self, trajectory: Trajectory, first: int, last: int) -> None:
        """Go on from step ``first`` up to ``last``, recorded in ``trajectory``."""
        own_loop = getattr(self.learner, "advance", None)
        learn = loop.learn if own_loop is None else own_loop
        self.state = learn(
            self.body, self.task, self.encoder, self.learner.stepped, self.algorithm, self.rule,
            self.state, self.actions, self.starts, trajectory, first, last,
        )  # fmt: skip


def body_of_run(spec: Spec) -> Pendulum:
    """The pendulum of a run, with φ measured from where its readings say (R1)."""
    upright = spec.readings.zero_of_angle == "upright"
    return body_of(spec.task.pendulum, FROM_UPRIGHT if upright else FROM_HANGING)


def prepare(spec: Spec, seed: int) -> Setting:
    """A run of ``spec`` before its first step."""
    readings, settings = spec.readings, spec.architecture
    options = settings.model_dump()
    actions, starts, weights, _, decisions = streams(seed)
    body = body_of_run(spec)
    task = tasks.create(spec.task.kind, readings, spec.task.model_dump())
    encoder = features.create(
        settings.coding, features.Plan(task, options, readings, spec.task.tiles)
    )
    scale = REWARD_SCALES[readings.reward_unit]
    learner = learners.create(
        settings.learner,
        learners.Beginning(
            encoder=encoder,
            options=options,
            readings=readings,
            lowest_q=-scale * task.largest_angle**2 / (1 - spec.discount),
            weights=weights,
            body=body,
        ),
    )
    printed_error = settings.learner == "networks" and readings.error_sign == "printed"
    rule = Rule(
        step_size=0.0 if spec.alpha is None else float(spec.alpha),
        discount=float(spec.discount),
        bootstrap_sign=-1.0 if printed_error else 1.0,
        reward_scale=scale,
        epsilon=float(spec.epsilon) if learner.epsilon is None else learner.epsilon,
        random_ties=readings.ties == "random",
    )
    return Setting(
        body=body,
        task=task,
        encoder=encoder,
        rule=rule,
        learner=learner,
        algorithm=new_algorithm(spec, encoder, learner, decisions),
        state=State(*tasks.start(task, starts), 0.0, 0.0),
        actions=actions,
        starts=starts,
    )


def new_algorithm(
    spec: Spec, encoder: Encoder, learner: Learner, draws: np.random.Generator
) -> NamedTuple:
    """The algorithm of ``spec`` with nothing remembered, to improve ``learner``."""
    options = spec.architecture.model_dump()
    actions = len(spec.task.pendulum.accelerations)
    design = algorithms.Design(
        encoder, float(spec.discount), options, spec.readings, draws, actions, learner.stepped
    )
    return algorithms.create(spec.architecture.method, design)
