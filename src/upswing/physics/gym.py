"""Both tasks as Gymnasium environments, for learners from elsewhere.

The pendulum, its starts, falls and rewards are those of the study, step for step, under the default
readings or others that are given; and it is the thesis's pendulum, or another, given as a configuration
gives it. Importing this module registers the environments, and so does
``gymnasium.make("upswing.physics.gym:upswing/FullControl-v0")`` by itself.
"""

from collections.abc import Mapping
from typing import Any, SupportsFloat, TypeVar

import gymnasium
import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ValidationError

from upswing.physics import tasks
from upswing.physics.actions import indices
from upswing.physics.environment import State, move
from upswing.physics.observation import Observation, largest_start, largest_velocity, observed
from upswing.physics.pendulum import FROM_HANGING, FROM_UPRIGHT, body_of
from upswing.physics.picture import WIDTH as SMALL
from upswing.physics.picture import picture
from upswing.physics.window import WIDTH, Window
from upswing.study.errors import explained
from upswing.study.physical import THESIS_TIME_STEP, PendulumOptions, StartOptions, TrackOptions
from upswing.study.readings import Readings
from upswing.study.task import kind_of_task

ENVIRONMENTS = {
    "upswing/Balancing-v0": "balancing",
    "upswing/FullControl-v0": "full-control",
}
"""The kind of task of each environment. An episode is cut after as many steps as the study's greedy
evaluation has: 10 s of the thesis's steps, and 20 s, which leaves time to swing up and to show that it
lasts. Gymnasium knows that number before it knows of another ``time_step``; then ``max_episode_steps``
says how long an episode is."""

M = TypeVar("M", bound=BaseModel)

RENDER_MODES = ("rgb_array", "human", "ansi")


class PendulumEnvironment(gymnasium.Env[Observation, np.int64]):
    """A task of the study.

    Observation (float64): cos φ, sin φ, φ̇ [rad/s], as in Gymnasium's own Pendulum. Full control keeps
    φ within one turn, and so this has no jump where φ has one; φ is atan2(sin φ, cos φ), and stands in
    ``info`` as it is. Action: an index into the accelerations of the cart, in the thesis −10, 0, +10
    m/s². Reward: −φ² [rad²] of the next state. ``info``: angle [rad], angular_velocity [rad/s],
    cart_position [m], cart_velocity [m/s].

    Balancing falls where |φ| passes 90°; full control never does, but at the ends of a track that says
    so (``at_end``). What a fall is to a learner is the
    reading R7. Under ``fallen``, the default, the study learns from the value of the fallen state, as if
    the pendulum went on from there: the episode is *truncated*, and its last observation is the fallen
    state. Under ``terminal`` nothing follows the fallen state: the episode is *terminated*. Under
    ``reset`` the next state is the new start, and the episode goes on.

    Args:
        kind: ``balancing`` or ``full-control``.
        render_mode: ``rgb_array``, ``human`` (a window, in real time) or ``ansi`` (a line of text).
        readings: readings by name that are not to be the default, ``{"reset": "terminal"}`` for example.
        track: the ends of the cart's track, with the keys of a configuration: ``{"limit": 2.0}``.
        start: where an episode starts, likewise: ``{"middle": 180, "within": 10}`` [°].
        pendulum: what is not the thesis's, likewise: ``length=0.4, accelerations=[-20, 0, 20]``.

    Raises:
        ValueError: there is no such render mode, reading or key, or its value cannot be.
        NoWindow: ``human``, where no window can be opened.
    """

    metadata = {  # noqa: RUF012  as Gymnasium declares it
        "render_modes": list(RENDER_MODES),
        "render_fps": round(1 / THESIS_TIME_STEP),  # a picture a step plays in real time
    }

    def __init__(
        self,
        kind: str,
        render_mode: str | None = None,
        readings: Mapping[str, Any] | None = None,
        *,
        track: Mapping[str, Any] | None = None,
        start: Mapping[str, Any] | None = None,
        **pendulum: Any,
    ) -> None:
        if render_mode not in (None, *RENDER_MODES):
            raise ValueError(f"render_mode: {render_mode!r}: must be {' or '.join(RENDER_MODES)}")
        self.render_mode = render_mode
        read = _valid(Readings, "readings", readings)
        ends, starts = _valid(TrackOptions, "track", track), _valid(StartOptions, "start", start)
        is_upright = read.zero_of_angle == "upright"
        self.body = body_of(
            _valid(PendulumOptions, "pendulum", pendulum),
            FROM_UPRIGHT if is_upright else FROM_HANGING,
        )
        self.task = tasks.create(
            kind, read, {"track": ends.model_dump(), "start": starts.model_dump()}
        )
        self.metadata = {**self.metadata, "render_fps": round(1 / self.body.time_step)}
        self.state = State(0.0, 0.0, 0.0, 0.0)
        limits = np.array([1.0, 1.0, largest_velocity(self.body, self.task)])
        self.observation_space = gymnasium.spaces.Box(-limits, limits, dtype=np.float64)
        self.action_space = gymnasium.spaces.Discrete(len(self.body.accelerations))
        self._window = Window(f"upswing: {kind}") if render_mode == "human" else None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Start anew, as the study does, or where the options ``angle``, ``angular_velocity`` say.

        Raises:
            ValueError: an option that there is not, or a start outside of the task.
        """
        super().reset(seed=seed)
        angle, angular_velocity = tasks.start(self.task, self.np_random)
        given = {"angle": angle, "angular_velocity": angular_velocity, **(options or {})}
        if len(given) > 2:
            raise ValueError(f"options: {sorted(given)}: must be angle and angular_velocity only")
        start = State(float(given["angle"]), float(given["angular_velocity"]), 0.0, 0.0)
        limit, fastest = self.task.largest_angle, largest_start(self.body, self.task)
        if not (abs(start.angle) <= limit and abs(start.angular_velocity) <= fastest):
            raise ValueError(
                f"options: {given}: must be a start with |φ| ≤ {limit:g} rad and "
                f"|φ̇| ≤ {fastest:g} rad/s"
            )
        self.state = start
        if self._window is not None:
            self._window.restart()
            self._show(self._window, 0.0)
        return self._observation(), self.state._asdict()

    def step(
        self, action: np.int64
    ) -> tuple[Observation, SupportsFloat, bool, bool, dict[str, Any]]:
        """One step, of 5 ms in the thesis.

        Raises:
            ValueError: an action that there is not.
        """
        if not self.action_space.contains(action):
            said = indices(len(self.body.accelerations))
            raise ValueError(f"action: {action!r}: must be {said}")
        before = self.state
        self.state = move(self.body, self.task, before, self.body.accelerations[action])
        fell = tasks.fallen(self.task, self.state.angle, self.state.cart_position)
        if fell and self.task.reset == tasks.RESET_START:
            self.state = State(*tasks.start(self.task, self.np_random), 0.0, 0.0)
        rewarded = self.state if self.task.rewards_next else before
        terminated = fell and self.task.reset == tasks.RESET_TERMINAL
        truncated = fell and self.task.reset == tasks.RESET_FALLEN
        if self._window is not None:
            self._show(self._window, self.body.time_step)
        reward = tasks.reward(rewarded.angle)
        return self._observation(), reward, terminated, truncated, self.state._asdict()

    def render(self) -> Any:
        """A picture (height, width, 3) or a line of text, as ``render_mode`` says; otherwise None."""
        if self.render_mode == "ansi":
            return "φ {:+.3f} rad, φ̇ {:+.3f} rad/s, x {:+.3f} m, ẋ {:+.3f} m/s".format(*self.state)
        return self._picture(SMALL) if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()

    def _observation(self) -> Observation:
        return observed(self.state.angle, self.state.angular_velocity)

    def _show(self, window: Window, passed: float) -> None:
        if window.is_due(passed):
            window.show(self._picture(WIDTH))

    def _picture(self, width: int) -> NDArray[np.uint8]:
        return picture(self.body, self.state, width, self.task.track.limit)


def _valid(model: type[M], name: str, given: Mapping[str, Any] | None) -> M:
    """The options of that name, as a configuration gives them."""
    try:
        return model.model_validate(dict(given or {}))
    except ValidationError as error:
        problems = explained(model, error, lambda *_: name)
        raise ValueError("; ".join(problems)) from None


for _id, _kind in ENVIRONMENTS.items():
    gymnasium.register(
        _id,
        entry_point="upswing.physics.gym:PendulumEnvironment",
        kwargs={"kind": _kind},
        max_episode_steps=kind_of_task(_kind).greedy_steps,
    )
