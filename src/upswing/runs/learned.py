"""What a run learned, read back from its weights file, and what it would do with it.

A file of weights says of which run it is: its metadata hold the run's specification, and from that
everything else is made anew. Nothing in it is executed: safetensors holds numbers and text only.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from safetensors import SafetensorError, safe_open

from upswing.agents.features import locate
from upswing.agents.learners import values
from upswing.agents.policy import Rule, epsilon_greedy
from upswing.physics.environment import State, Trajectory, empty_trajectory
from upswing.physics.jit import compiled
from upswing.runs.simulation import Setting, new_algorithm, prepare, streams
from upswing.study.errors import BadInput
from upswing.study.ids import file_of
from upswing.study.spec import Spec, parse

WEIGHTS = "weights.safetensors"
LONGEST_HEADER = 100_000
"""Largest header of a file of weights [bytes]: a specification, names and shapes of some arrays."""

FOLLOWED = 4_000
"""How long a policy is followed where nothing is said: 20 s [steps of 5 ms]."""

Real = NDArray[np.float64]


@dataclass(frozen=True)
class Learned:
    """What a run learned, frozen.

    ``spec`` is the specification of this run alone, ``arrays`` what its learner calls ``learned``, by
    name. ``setting`` is for asking; whoever moves the system takes one of their own by ``following``.
    """

    spec: Spec
    arrays: Mapping[str, NDArray[Any]]

    @property
    def seed(self) -> int:
        """The seed of the run."""
        return self.spec.seeds[0]

    @property
    def run(self) -> str:
        """The id of the run."""
        return self.spec.run(self.seed)

    @cached_property
    def setting(self) -> Setting:
        """The run with what it learned; the same for every question."""
        return self._restored()

    @property
    def accelerations(self) -> tuple[float, ...]:
        """What each action does to the cart [m/s²], ascending: −10, 0 and +10 in the thesis."""
        return tuple(self.setting.body.accelerations)

    def values(self, angle: ArrayLike, angular_velocity: ArrayLike) -> Real:
        """Q of the actions [the unit of R3] in states φ [rad], φ̇ [rad/s].

        Both are numbers or arrays, of shapes that go together; the answer has that shape and behind it
        the actions, in the order of ``accelerations``. They are what the loop reads, bit for bit. Of a
        learner that holds a policy and no Q they are its preferences.
        """
        return self._asked(angle, angular_velocity)[0]

    def policy(self, angle: ArrayLike, angular_velocity: ArrayLike) -> Real:
        """The greedy action as the acceleration of the cart ẍ [m/s²], of the shape of the states.

        States φ [rad], φ̇ [rad/s] are as in ``values``. Among equal values one is chosen as R6 says of
        the run; where that is at random, by the run's own stream for greedy evaluation, anew at every
        call, so that the same question has the same answer. A random control draws from it likewise.
        """
        return self._asked(angle, angular_velocity)[1]

    def following(self, angle: float, angular_velocity: float = 0.0) -> Setting:
        """The system at φ [rad], φ̇ [rad/s], cart at rest at 0, under the greedy policy.

        It is as in ``runs/evaluation.py``: ε = 0 but for a random control, and α = 0. Its ``advance``
        may be called piece by piece, with its ``state`` changed between them. Each has what was
        learned for itself.
        """
        setting = self._restored()
        *_, stream, decisions = streams(self.seed)
        return replace(
            setting,
            rule=_frozen(setting),
            state=State(float(angle), float(angular_velocity), 0.0, 0.0),
            algorithm=new_algorithm(self.spec, setting.encoder, setting.learner, decisions),
            actions=stream,
            starts=stream,
        )

    def simulate(
        self,
        angle: float,
        angular_velocity: float = 0.0,
        steps: int | None = None,
        pushes: Mapping[int, float] | None = None,
    ) -> Trajectory:
        """So many steps from φ [rad], φ̇ [rad/s], following the greedy policy.

        Without ``steps`` it is followed for 20 s.
        ``pushes`` says of steps by how much φ̇ is changed before them [rad/s]. After a fall it starts
        anew where the task does.
        """
        steps = self.spec.task.steps_of(FOLLOWED) if steps is None else steps
        trajectory, at = empty_trajectory(steps), 0
        setting = self.following(angle, angular_velocity)
        for step, push in sorted((pushes or {}).items()):
            until = min(max(step, 0), steps)
            setting.advance(trajectory, at, until)
            pushed = setting.state.angular_velocity + push
            setting.state, at = setting.state._replace(angular_velocity=pushed), until
        setting.advance(trajectory, at, steps)
        return trajectory

    def _restored(self) -> Setting:
        setting = prepare(self.spec, self.seed)
        for name, array in setting.learner.learned.items():  # the memory that the loop steps
            array[...] = self.arrays[name]
        return setting

    def _asked(self, angle: ArrayLike, angular_velocity: ArrayLike) -> tuple[Real, Real]:
        setting = self.setting
        angles, velocities = np.broadcast_arrays(
            np.asarray(angle, np.float64), np.asarray(angular_velocity, np.float64)
        )
        if setting.task.wraps:  # within one turn, as the system keeps it
            turned = (angles + np.pi) % (2 * np.pi) - np.pi
            angles = np.where(np.abs(angles) <= np.pi, angles, turned)
        actions = len(self.accelerations)
        q, chosen = np.empty((angles.size, actions)), np.empty(angles.size)
        *_, stream, _ = streams(self.seed)
        _ask(
            setting.encoder, setting.learner.stepped, _frozen(setting), stream,
            self.accelerations, angles.ravel(), velocities.ravel(), q, chosen,
        )  # fmt: skip
        return q.reshape(*angles.shape, actions), chosen.reshape(angles.shape)


@compiled
def _ask(
    encoder: Any,
    learner: Any,
    rule: Rule,
    draws: np.random.Generator,
    accelerations: tuple[float, ...],
    angles: Real,
    velocities: Real,
    q: Real,
    chosen: Real,
) -> None:
    """Fill in Q (states, actions) and the accelerations that are chosen in so many states."""
    for i in range(len(angles)):
        found = values(learner, locate(encoder, angles[i], velocities[i]))
        for action in range(len(accelerations)):
            q[i, action] = found[action]
        greedy = epsilon_greedy(found, rule.epsilon, rule.random_ties, draws.random())
        chosen[i] = accelerations[greedy]


def _frozen(setting: Setting) -> Rule:
    """The rule without learning and exploring; a control keeps its own ε."""
    epsilon = 0.0 if setting.learner.epsilon is None else setting.learner.epsilon
    return setting.rule._replace(step_size=0.0, epsilon=epsilon)


def learned_by(results: Path, run: str) -> Learned:
    """What a run in the folder ``results`` learned.

    Raises:
        BadInput: there is no such file, it cannot be read, or it is of another run.
    """
    path = results / file_of(run, WEIGHTS)
    found = load_learned(path)
    if found.run != run:
        raise BadInput([f"{path}: is of {found.run}; run the study again to make it"])
    return found


def load_learned(path: Path) -> Learned:
    """What is in a file of weights, wherever it lies.

    Raises:
        BadInput: it is missing, is no such file, or is not what its specification would learn.
    """
    text, arrays = _read(path)
    try:
        spec = parse(text)
    except BadInput as error:
        raise BadInput([f"{path}: {problem}" for problem in error.problems]) from None
    if len(spec.seeds) != 1:
        raise BadInput([f"{path}: seeds: {list(spec.seeds)}: weights are of one run"])
    expected = prepare(spec, spec.seeds[0]).learner.learned
    if set(expected) != set(arrays):
        wanted = f"{spec.architecture.name} has {', '.join(sorted(expected))}"
        raise BadInput([f"{path}: holds {', '.join(sorted(arrays)) or 'nothing'}; {wanted}"])
    for name, array in expected.items():
        found = arrays[name]
        if found.shape != array.shape or found.dtype != array.dtype:
            raise BadInput(
                [
                    f"{path}: {name}: has shape {found.shape} of {found.dtype}; "
                    f"{spec.architecture.name} has {array.shape} of {array.dtype}"
                ]
            )
    return Learned(spec, arrays)


def _read(path: Path) -> tuple[str, dict[str, NDArray[Any]]]:
    """The specification and the arrays of a file of weights."""
    if not path.is_file():
        raise BadInput([f"{path}: missing; it should be a file *.{WEIGHTS} of a run"])
    try:
        with path.open("rb") as file:
            header = int.from_bytes(file.read(8), "little")
        if not 0 < header <= LONGEST_HEADER:
            raise BadInput(
                [f"{path}: is no file of weights: its header would have {header:,} bytes"]
            )
        with safe_open(path, "np") as file:
            said = file.metadata() or {}
            arrays = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118
    except (OSError, SafetensorError, ValueError, TypeError) as error:
        if isinstance(error, BadInput):
            raise
        words = str(error).splitlines() or [type(error).__name__]
        raise BadInput([f"{path}: cannot be read: {words[0]}"]) from None
    if "spec" not in said:
        raise BadInput([f"{path}: does not say of which run it is: there is no `spec` in it"])
    return said["spec"], arrays
