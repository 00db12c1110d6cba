"""What was learned, as something that can be called: states → accelerations of the cart."""

from collections.abc import Iterator, Mapping
from math import isfinite
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from upswing.api.frames import of_simulation
from upswing.physics.tasks import Task
from upswing.runs.learned import Learned, load_learned
from upswing.study.errors import BadInput, problem
from upswing.study.spec import Spec
from upswing.study.values import LONGEST_RUN

if TYPE_CHECKING:
    import pandas as pd

Real = NDArray[np.float64]


class Policy:
    """The greedy policy of a run, frozen: ``policy(φ, φ̇)`` is the acceleration of the cart.

    Attributes:
        learned: what the run learned, with its learner; see ``upswing.runs.learned``.
    """

    def __init__(self, learned: Learned) -> None:
        self.learned = learned

    @property
    def spec(self) -> Spec:
        """The specification of the run that learned it."""
        return self.learned.spec

    @property
    def run(self) -> str:
        """The id of that run."""
        return self.learned.run

    @property
    def accelerations(self) -> tuple[float, ...]:
        """What each action does to the cart [m/s²], ascending: −10, 0 and +10 in the thesis."""
        return self.learned.accelerations

    @property
    def weights(self) -> Mapping[str, NDArray[Any]]:
        """What was learned by name: a table's ``q`` (modules, tiles, actions), networks' weights …."""
        return {name: array.copy() for name, array in self.learned.arrays.items()}

    def __call__(self, angle: ArrayLike, angular_velocity: ArrayLike) -> Any:
        """The acceleration ẍ of the cart [m/s²], one of ``accelerations``, in states φ [rad], φ̇ [rad/s].

        Numbers give a number; arrays of shapes that go together give an array of theirs. φ is 0
        upright (under the default reading R1); full control knows no number of turns. Where several
        actions are worth the same, one is chosen as R6 says of the run; the same question always has
        the same answer. A DQN holds what it decides for some steps, as ``simulate`` does.
        """
        found = self.learned.policy(*_states(angle, angular_velocity))
        return float(found) if found.ndim == 0 else found

    def values(self, angle: ArrayLike, angular_velocity: ArrayLike) -> Real:
        """Q of each of ``accelerations``, shape (…, actions), in the unit of reading R3."""
        return self.learned.values(*_states(angle, angular_velocity))

    def simulate(
        self,
        angle: float | None = None,
        angular_velocity: float = 0.0,
        seconds: float = 20.0,
        pushes: Mapping[float, float] | None = None,
    ) -> "pd.DataFrame":
        """Follow the policy from a state: without learning, without exploring.

        Args:
            angle: φ at the start [rad]; without, the first start of the task's evaluation, which is
                hanging (−π) for full control and −20° for balancing.
            angular_velocity: φ̇ at the start [rad/s].
            seconds: for how long [s], in steps of the task's own.
            pushes: after how many seconds φ̇ is changed, and by how much [rad/s]: ``{5.0: 2.0}``.

        Returns:
            A row a step: ``step``, ``time`` [s], ``angle`` φ [rad], ``angular_velocity`` φ̇ [rad/s],
            ``cart_position`` x [m], ``cart_velocity`` ẋ [m/s], ``acceleration`` ẍ [m/s²], ``reward``
            [rad²], and ``reset``: whether this step led to a fall, after which the next one starts
            anew. The units stand in ``attrs["units"]``.

        Raises:
            BadInput: a start that the task has not, or no time at all.
        """
        task, body = self.learned.setting.task, self.learned.setting.body
        time_step = body.time_step
        start = self.spec.task.greedy_starts[0] if angle is None else float(angle)
        given = pushes or {}
        if wrong := list(_wrong(task, time_step, start, angular_velocity, seconds, given)):
            raise BadInput(wrong)
        if task.wraps and abs(start) > np.pi:
            start = (start + np.pi) % (2 * np.pi) - np.pi
        by_step: dict[int, float] = {}
        for second, push in given.items():  # two in one step are both felt
            step = round(second / time_step)
            by_step[step] = by_step.get(step, 0.0) + push
        steps = round(seconds / time_step)
        followed = self.learned.simulate(start, angular_velocity, steps, by_step)
        return of_simulation(followed, body)

    def __repr__(self) -> str:
        one = f"one of {self.accelerations} m/s²"
        return f"<policy learned by {self.run}: (φ [rad], φ̇ [rad/s]) → {one}>"


def load(path: str | PathLike[str]) -> Policy:
    """The policy in a file of weights (``….weights.safetensors``), wherever it lies.

    The file says of which run it is; nothing else of the study is needed.

    Raises:
        BadInput: it is missing, or no such file.
    """
    return Policy(load_learned(Path(path)))


def _states(angle: ArrayLike, angular_velocity: ArrayLike) -> tuple[Real, Real]:
    """States as arrays; ``BadInput`` if they are no finite numbers or of shapes that differ."""
    try:
        angles, velocities = np.asarray(angle, float), np.asarray(angular_velocity, float)
        np.broadcast_shapes(angles.shape, velocities.shape)
    except (TypeError, ValueError) as error:
        raise BadInput([f"policy: φ, φ̇: {str(error).splitlines()[0]}"]) from None
    if not (np.isfinite(angles).all() and np.isfinite(velocities).all()):
        raise BadInput(["policy: φ, φ̇: must be finite numbers [rad], [rad/s]"])
    return angles, velocities


def _wrong(
    task: Task,
    time_step: float,
    angle: float,
    angular_velocity: float,
    seconds: float,
    pushes: Mapping[float, float],
) -> Iterator[str]:
    """What of a simulation cannot be."""
    if not isfinite(angle):
        yield problem("simulate", "angle", angle, "must be a number [rad]")
    elif abs(angle) > task.critical_angle:
        right = f"must be within ±{task.critical_angle:.5g} rad, where this task ends"
        yield problem("simulate", "angle", angle, right)
    if not isfinite(angular_velocity):
        yield problem("simulate", "angular_velocity", angular_velocity, "must be a number [rad/s]")
    longest = LONGEST_RUN * time_step
    if not time_step <= seconds <= longest:
        right = f"must be between {time_step:g} and {longest:,.0f} [s]"
        yield problem("simulate", "seconds", seconds, right)
    for second, push in pushes.items():
        is_felt = 0 <= second < seconds and round(second / time_step) < round(seconds / time_step)
        if not is_felt or not isfinite(push):
            right = "must be seconds within the time, and a change of φ̇ [rad/s]"
            yield problem("simulate", "pushes", {second: push}, right)
