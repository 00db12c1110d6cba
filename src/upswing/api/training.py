"""Training a run in this process: bit for bit the study's run of the same specification."""

import time
from collections.abc import Mapping
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from upswing.api.asked import Given, specified
from upswing.api.frames import of_trajectory, of_windows
from upswing.api.policy import Policy
from upswing.api.run import Run
from upswing.api.thesis import THESIS
from upswing.physics.environment import Trajectory, empty_trajectory
from upswing.runs.endings import endings
from upswing.runs.learned import Learned
from upswing.runs.outcome import Outcome, outcome_of
from upswing.runs.rows import framed
from upswing.runs.simulation import Setting, prepare
from upswing.runs.snapshots import moments
from upswing.study.spec import Spec


def train(
    task: Given = "balancing",
    architecture: Given = "table",
    alpha: float | None = None,
    seed: int = 0,
    steps: int | None = None,
    *,
    epsilon: float | None = None,
    discount: float | None = None,
    readings: Mapping[str, Any] | None = None,
    pendulum: Mapping[str, Any] | None = None,
) -> Run:
    """Train a run in this process; nothing is written.

    Where its specification is that of a run of the study, it is this run, bit for bit.
    ``Study.train`` takes the names of a study of one's own.

    Args:
        task: a task of the thesis by its name (``balancing``, ``full-control``,
            ``full-control-long``), or its keys as in a configuration.
        architecture: one of the thesis by its name (``table``, ``networks-5`` …), or its keys:
            ``{"learner": "networks", "hidden": [10]}``.
        alpha: the step size α in (0, 1]; None for a control.
        seed: of the random numbers; the thesis's study has those from 10,000 on.
        steps: its length in place of the task's [steps].
        epsilon: the share of random actions, 0.01 without.
        discount: γ, 0.7 without.
        readings: what the thesis leaves open, by the keys of R1–R15; the defaults without.
        pendulum: another pendulum, or other actions: ``{"length": 0.4, "accelerations": [-20, 0, 20]}``;
            what it does not name is as the task has it.

    Raises:
        BadInput: something is not known or does not go together.
    """
    return learned_here(
        specified(
            THESIS, task, architecture, alpha, seed, steps, epsilon, discount, readings, pendulum
        )
    )  # fmt: skip


class OwnRun(Run):
    """A run that was learned in this process."""

    recording = None

    def __init__(
        self,
        spec: Spec,
        trajectory: Trajectory,
        setting: Setting,
        outcome: Outcome,
        seconds: float,
        origin: str,
    ) -> None:
        super().__init__(spec)
        self.origin, self._trajectory, self._outcome = origin, trajectory, outcome
        learned = {name: array.copy() for name, array in setting.learner.learned.items()}
        self._policy = Policy(Learned(spec, learned))
        self._seconds = seconds

    @cached_property
    def _row(self) -> "pd.Series[Any]":
        steps, seconds = self.task.steps, self._seconds
        row = {
            **self.spec.columns(self.seed),
            **self._outcome.row,
            **endings(self._outcome.windows),
            "seconds": seconds,
            "steps_per_second": steps / seconds,
            "spec": self.spec.canonical(),
        }
        return framed([row]).iloc[0]

    @property
    def trajectory(self) -> pd.DataFrame:
        """Every step; see ``Run.trajectory``."""
        return self.at(np.arange(self.task.steps))

    def at(self, steps: NDArray[np.int64]) -> pd.DataFrame:
        """Some steps of the trajectory, shape (rows,)."""
        return of_trajectory(self._trajectory, steps)

    @property
    def windows(self) -> pd.DataFrame:
        """The whole run in windows; see ``Run.windows``."""
        return of_windows(self._outcome.windows)

    @property
    def policy(self) -> Policy:
        """What it learned."""
        return self._policy


def learned_here(spec: Spec, origin: str = "learned here") -> OwnRun:
    """The run of a specification of one seed, learned in this process."""
    seed, trajectory = spec.seeds[0], empty_trajectory(spec.task.steps)
    setting = prepare(spec, seed)
    setting.advance(trajectory, 0, 0)  # compiles, or fetches what was compiled
    began = time.perf_counter()
    for first, last in pairwise(moments(spec.task.steps).tolist()):  # so that Ctrl-C is heard
        setting.advance(trajectory, first, last)
    seconds = time.perf_counter() - began
    if spec.alpha is None:
        trajectory.td_error.fill(np.nan)  # as a stored control has it: it learns nothing
    outcome = outcome_of(spec, seed, setting, trajectory)
    return OwnRun(spec, trajectory, setting, outcome, seconds, origin)
