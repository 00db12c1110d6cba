"""A run: what was stored or just learned of it, its policy, and learning it again."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from upswing.api.frames import UNITS, UNITS_OF_WINDOWS, with_units
from upswing.api.policy import Policy
from upswing.api.shown import table_of
from upswing.runs.files.trajectory import OF_A_TRAJECTORY, OF_WINDOWS
from upswing.runs.files.typed_table import Columns, read_table
from upswing.runs.learned import learned_by
from upswing.runs.results import TRAJECTORY, WINDOWS
from upswing.runs.rows import collected
from upswing.study.config import ADOPTED
from upswing.study.errors import BadInput
from upswing.study.ids import file_of, recording_of
from upswing.study.spec import Spec
from upswing.study.task import NamedTask

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ALWAYS_SHOWN = ("first_stable_step", "greedy_success_share")


class DifferentRun(RuntimeError):
    """A run that was learned again came out differently; its text says where first."""


class Run(ABC):
    """A run, stored in a folder of results or learned in this process.

    Attributes:
        spec: its specification: everything that it depends on besides the code.
    """

    origin: str
    """Where it is from, in words."""

    def __init__(self, spec: Spec) -> None:
        self.spec = spec

    @property
    def id(self) -> str:
        """Which run it is: ``balancing/table/alpha-0.5/seed-10003``."""
        return self.spec.run(self.seed)

    @property
    def seed(self) -> int:
        """Its seed."""
        return self.spec.seeds[0]

    @property
    def task(self) -> NamedTask:
        """Its task, with its length and how it is judged."""
        return self.spec.task

    @property
    def measures(self) -> "pd.Series[Any]":
        """Its row of the table of runs; ``docs/results.md`` says what each measure is."""
        return self._row.copy()

    @property
    @abstractmethod
    def trajectory(self) -> pd.DataFrame:
        """Its steps, a row each; the state is the one *before* the action.

        ``step``, of the task's time step, 5 ms in the thesis; ``angle`` φ [rad], 0 upright;
        ``angular_velocity`` φ̇ [rad/s]; ``cart_position`` x [m]; ``cart_velocity`` ẋ [m/s]; ``action``,
        an index into ``policy.accelerations``; ``reward`` [rad²]; ``td_error`` δ [rad²], NaN where
        nothing was learned; ``reset``, whether the action led to a fall and so to a new start. The
        units stand in ``attrs["units"]``.

        Of a stored run those steps that were kept: the first 5,000 and last 2,500, those around its
        first falls and its first success, and every n-th between. Of one learned here every step.
        """

    @property
    @abstractmethod
    def windows(self) -> pd.DataFrame:
        """The whole run in at most 1,000 windows, measured from every step.

        ``first_step``, ``steps``, ``falls``, ``upright_share``, ``above_horizontal_share``,
        ``mean_reward`` [rad²], ``lowest_angle`` and ``highest_angle`` [rad], ``highest_speed`` |φ̇|
        [rad/s], ``mean_td_error`` |δ| [rad²], ``swing_ups``, ``too_fast``, ``excursions``,
        ``recovered``. The units stand in ``attrs["units"]``.
        """

    @property
    @abstractmethod
    def policy(self) -> Policy:
        """What it learned, to be called: ``run.policy(φ, φ̇)`` is the acceleration [m/s²]."""

    @property
    @abstractmethod
    def recording(self) -> Path | None:
        """The path of its recording, which ``rerun`` and ``upswing browse`` open; None without one."""

    @property
    @abstractmethod
    def _row(self) -> "pd.Series[Any]": ...

    @property
    def weights(self) -> Mapping[str, NDArray[Any]]:
        """What it learned by name, as in its file of weights."""
        return self.policy.weights

    def values(self, angle: ArrayLike, angular_velocity: ArrayLike) -> NDArray[np.float64]:
        """Q of each of ``policy.accelerations`` in states φ [rad], φ̇ [rad/s]: shape (…, actions)."""
        return self.policy.values(angle, angular_velocity)

    def simulate(
        self,
        angle: float | None = None,
        angular_velocity: float = 0.0,
        seconds: float = 20.0,
        pushes: Mapping[float, float] | None = None,
    ) -> pd.DataFrame:
        """Follow what it learned from a state φ [rad], φ̇ [rad/s]; see ``Policy.simulate``."""
        return self.policy.simulate(angle, angular_velocity, seconds, pushes)

    def replay(self) -> "Run":
        """Learn it again from its specification, bit for bit, and hold the two against each other.

        Returns:
            The run as it was just learned, with every one of its steps.

        Raises:
            DifferentRun: a stored step, a window or a weight differs in a single bit.
            BadInput: it is of an agent from elsewhere, which only ``upswing adopt`` asks.
        """
        from upswing.api.training import learned_here

        if self.spec.architecture.learner == ADOPTED:
            raise BadInput(
                [f"{self.id}: is of an agent from elsewhere; `upswing adopt` runs it again"]
            )
        digest, first = self.measures["digest"], self.trajectory
        again = learned_here(self.spec, "learned again: bit for bit the same")
        other = again.at(first["step"].to_numpy())
        for name in first.columns:
            if len(steps := np.flatnonzero(_differs(first[name], other[name]))):
                raise self._different(f"step {first['step'].iloc[steps[0]]:,}: {name}")
        if again.measures["digest"] != digest:
            raise self._different("the windows")
        for name, array in self.weights.items():
            if _differs(array, again.weights[name]).any():
                raise self._different(f"the weights: {name}")
        return again

    def plot(self) -> "Figure":
        """φ at the beginning and over the whole run, how it learned, and its policy: four panels."""
        from upswing.api.plot import figure_of_run

        return figure_of_run(self)

    def _different(self, where: str) -> DifferentRun:
        commit = str(self.measures.get("git_commit", "unknown"))[:12]
        return DifferentRun(
            f"{self.id}: learned again it differs, first in {where}; it was made by commit {commit}"
        )

    def __repr__(self) -> str:
        return f"<run {self.id}, {self.origin}>"

    def _repr_html_(self) -> str:
        names = dict.fromkeys((*self.task.first_measures, *ALWAYS_SHOWN))
        rows = {name: self._row[name] for name in names if name in self._row}
        return table_of(f"{self.id}, {self.origin}", {"steps": self.task.steps, **rows})


class StoredRun(Run):
    """A run in a folder of results; its files are read when they are asked for."""

    origin = "as it is stored"

    def __init__(self, folder: Path, spec: Spec) -> None:
        super().__init__(spec)
        self.folder = folder

    @cached_property
    def _row(self) -> "pd.Series[Any]":
        return collected(self.folder, [self.spec]).iloc[0]

    @property
    def trajectory(self) -> pd.DataFrame:
        """Its stored steps; see ``Run.trajectory``."""
        return with_units(self._read(TRAJECTORY, OF_A_TRAJECTORY), UNITS)

    @property
    def windows(self) -> pd.DataFrame:
        """The whole run in windows; see ``Run.windows``."""
        return with_units(self._read(WINDOWS, OF_WINDOWS), UNITS_OF_WINDOWS)

    @cached_property
    def policy(self) -> Policy:
        """What it learned, read from its file of weights."""
        learned = learned_by(self.folder, self.id)
        if learned.spec.canonical() != self.spec.canonical():
            path = self.folder / file_of(self.id, "weights.safetensors")
            raise BadInput([f"{path}: is of another specification; run the study again to make it"])
        return Policy(learned)

    @property
    def recording(self) -> Path | None:
        """The path of its recording; None where it is missing."""
        path = self.folder / recording_of(self.id)
        return path if path.is_file() else None

    def _read(self, file: str, columns: Columns) -> pd.DataFrame:
        path = self.folder / file_of(self.id, file)
        return read_table(path, columns, "run the study again to make it")


def _differs(one: Any, other: Any) -> NDArray[np.bool_]:
    """Where two arrays differ in a bit, NaN being NaN."""
    a, b = np.asarray(one), np.asarray(other)
    both_nan = (a != a) & (b != b)
    signs = np.signbit(a) != np.signbit(b) if a.dtype.kind == "f" else False  # −0 equals 0
    return np.asarray(((a != b) | signs) & ~both_nan)
