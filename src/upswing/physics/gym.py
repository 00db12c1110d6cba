"""Both tasks as Gymnasium environments, for learners from elsewhere.

The pendulum, its starts, falls and rewards are those of the study, step for step of 5 ms, under the
default readings. Gymnasium is an extra; importing this module registers the environments, and so does
``gymnasium.make("upswing.physics.gym:upswing/FullControl-v0")`` by itself.
"""

from math import hypot
from typing import Any, SupportsFloat

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from upswing.physics import tasks
from upswing.physics.elementary import sine_and_cosine
from upswing.physics.environment import State, move
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import ACCELERATIONS, ACTIONS
from upswing.study.readings import Readings
from upswing.study.task import kind_of_task

try:
    import gymnasium
except ImportError:
    raise ImportError(
        "upswing.physics.gym needs Gymnasium, the extra `gymnasium`: pip install -e '.[gymnasium]'"
    ) from None

Observation = NDArray[np.float64]

ENVIRONMENTS = {
    "upswing/Balancing-v0": "balancing",
    "upswing/FullControl-v0": "full-control",
}
"""The kind of task of each environment. An episode is cut as the study's greedy evaluation is: after
10 s, and after 20 s, which leaves time to swing up and to show that it lasts."""

RENDER_MODES = ("rgb_array", "ansi")
PICTURE = (240, 160)
"""Width and height of a picture [pixels]; it shows 0.9 m × 0.6 m around the cart."""

PIXELS_PER_METRE = PICTURE[0] / 0.9
MARKS = 0.1
"""Between two marks on the ground, by which one sees the cart move [m]."""


def largest_velocity(body: Pendulum) -> float:
    """What |φ̇| never passes [rad/s]: where friction eats the largest torque there can be (eq. 14–17).

    From below it, one step leads to at most (1 − f_c/J·dt) of it plus f_c/J·dt of it.
    """
    push = max(ACCELERATIONS)
    return body.mass * body.length / 2 * hypot(body.gravity, push) / body.friction


class PendulumEnvironment(gymnasium.Env[Observation, np.int64]):
    """A task of the study.

    Observation (float64): cos φ, sin φ, φ̇ [rad/s], as in Gymnasium's own Pendulum. Full control keeps
    φ within one turn, and so this has no jump where φ has one; φ is atan2(sin φ, cos φ), and stands in
    ``info`` as it is. Action: an index into −10, 0, +10 m/s². Reward: −φ² [rad²] of the next state.
    ``info``: angle [rad], angular_velocity [rad/s], cart_position [m], cart_velocity [m/s].

    Balancing terminates where |φ| passes 90°; full control never does.
    """

    metadata = {  # noqa: RUF012  as Gymnasium declares it
        "render_modes": list(RENDER_MODES),
        "render_fps": round(1 / Pendulum().time_step),  # a picture a step plays in real time
    }

    def __init__(self, kind: str, render_mode: str | None = None) -> None:
        if render_mode not in (None, *RENDER_MODES):
            raise ValueError(f"render_mode: {render_mode!r}: must be {' or '.join(RENDER_MODES)}")
        self.render_mode = render_mode
        self.body = Pendulum()
        self.task = tasks.create(kind, Readings())
        self.state = State(0.0, 0.0, 0.0, 0.0)
        limits = np.array([1.0, 1.0, largest_velocity(self.body)])
        self.observation_space = gymnasium.spaces.Box(-limits, limits, dtype=np.float64)
        self.action_space = gymnasium.spaces.Discrete(ACTIONS)

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
        limit = self.task.largest_angle
        if not (
            abs(start.angle) <= limit
            and abs(start.angular_velocity) <= self.observation_space.high[2]  # type: ignore[attr-defined]
        ):
            raise ValueError(f"options: {given}: must be a start with |φ| ≤ {limit:g} rad")
        self.state = start
        return self._observation(), self._info()

    def step(
        self, action: np.int64
    ) -> tuple[Observation, SupportsFloat, bool, bool, dict[str, Any]]:
        """One step of 5 ms.

        Raises:
            ValueError: an action that there is not.
        """
        if not self.action_space.contains(action):
            raise ValueError(f"action: {action!r}: must be 0, 1 or 2")
        self.state = move(self.body, self.task, self.state, ACCELERATIONS[action])
        reward = tasks.reward(self.state.angle)
        fell = tasks.fallen(self.task, self.state.angle)
        return self._observation(), reward, fell, False, self._info()

    def render(self) -> Any:
        """A picture (height, width, 3) or a line of text, as ``render_mode`` says; None without one."""
        if self.render_mode == "ansi":
            return "φ {:+.3f} rad, φ̇ {:+.3f} rad/s, x {:+.3f} m, ẋ {:+.3f} m/s".format(*self.state)
        return _picture(self.body, self.state) if self.render_mode == "rgb_array" else None

    def _observation(self) -> Observation:
        sine, cosine = sine_and_cosine(self.state.angle)
        return np.array([cosine, sine, self.state.angular_velocity])

    def _info(self) -> dict[str, Any]:
        return self.state._asdict()


def _picture(body: Pendulum, state: State) -> NDArray[np.uint8]:
    """The pendulum on its cart, which stays in the middle while the ground passes."""
    image = Image.new("RGB", PICTURE, "white")
    draw = ImageDraw.Draw(image)
    width, height = PICTURE
    ground, middle = height * 0.6, width / 2
    draw.line([(0, ground), (width, ground)], fill="grey")
    first = -(state.cart_position % MARKS)
    for mark in np.arange(first - 5 * MARKS, 6 * MARKS, MARKS):
        at = middle + mark * PIXELS_PER_METRE
        draw.line([(at, ground), (at, ground + 4)], fill="grey")
    draw.rectangle([middle - 14, ground - 5, middle + 14, ground + 5], fill="black")
    sine, cosine = sine_and_cosine(state.angle)
    reach = body.length * PIXELS_PER_METRE
    # M_C of eq. 16 turns φ towards where the cart accelerates: a positive φ leans to negative x.
    tip = (middle - reach * sine, ground - reach * cosine)
    draw.line([(middle, ground), tip], fill="firebrick", width=5)
    return np.asarray(image).copy()


for _id, _kind in ENVIRONMENTS.items():
    gymnasium.register(
        _id,
        entry_point="upswing.physics.gym:PendulumEnvironment",
        kwargs={"kind": _kind},
        max_episode_steps=kind_of_task(_kind).greedy_steps,
    )
