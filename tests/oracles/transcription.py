"""The thesis in plain numpy, written from its text and the ledger alone: slow, and for comparison.

Nothing is kept, nothing is compiled, every network is evaluated as matrices on one-hot vectors. An
upright pendulum multiplies a rounding error by e⁴³ within 1,000 steps, so the formulas keep the order
in which the thesis prints them.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit

from upswing.physics.elementary import sine_and_cosine
from upswing.study.spec import Spec

SCALE = {"half_turn": 2.0, "radians": 1.0, "degrees": 180 / np.pi}


def transcribe(spec: Spec, seed: int, learned: dict[str, NDArray[Any]]) -> dict[str, list[Any]]:
    """A run of ``spec`` that begins with ``learned``, which is changed; columns by name."""
    readings, kind, pushes = spec.readings, spec.task.kind, spec.task.pendulum.accelerations
    modular = spec.architecture.is_modular
    streams = [np.random.default_rng(s) for s in np.random.SeedSequence(seed).spawn(3)]
    q_of = (
        Networks(spec, learned)
        if spec.architecture.learner == "networks"
        else TableOrControl(spec, learned)
    )
    epsilon = {"idle": 0.0, "random": 1.0, None: spec.epsilon}[
        getattr(spec.architecture, "behaviour", None)
    ]
    columns: dict[str, list[Any]] = {
        name: [] for name in ("angle", "angular_velocity", "action", "reward", "td_error", "reset")
    }
    left_open: dict[int, tuple[int, int, int, float]] = {}
    angle, velocity = begin(spec, streams[1])
    for t in range(spec.task.steps):
        module, tile = code(spec, angle, velocity)
        if module in left_open:
            when, old_tile, old_action, old_reward = left_open.pop(module)
            target = old_reward + q_of.sign * spec.discount * q_of(module, tile).max()
            error = target - q_of(module, old_tile)[old_action]
            q_of.learn(module, old_tile, old_action, error)
            columns["td_error"][when] = error
        q = q_of(module, tile)
        u = streams[0].random()
        if u < epsilon:
            action = int(u / epsilon * len(pushes))
        else:
            best = np.flatnonzero(q == q.max())
            pick = int((u - epsilon) / (1 - epsilon) * len(best)) if epsilon < 1 else 0
            action = int(best[pick if readings.ties == "random" else 0])
        new_angle, new_velocity = move(spec, angle, velocity, pushes[action])
        if kind == "full-control" and readings.wrap == "wrapped":
            new_angle -= 2 * np.pi if new_angle >= np.pi else 0
            new_angle += 2 * np.pi if new_angle < -np.pi else 0
        fell = kind == "balancing" and abs(new_angle) > np.pi / 2
        seen = (new_angle, new_velocity)
        if fell:
            new_angle, new_velocity = begin(spec, streams[1])
            if readings.reset == "reset":
                seen = (new_angle, new_velocity)
        judged = seen[0] if readings.reward_state == "next" else angle
        reward = -((SCALE[readings.reward_unit] * judged) ** 2)
        next_module, next_tile = code(spec, *seen)
        ended = fell and readings.reset == "terminal"
        crossed = modular and next_module != module
        if crossed and readings.hand_over == "own" and not ended:
            left_open[module] = (t, tile, action, reward)
            error = np.nan
        else:
            future = 0.0
            if not ended and not (crossed and readings.hand_over == "terminal"):
                future = q_of.sign * spec.discount * q_of(next_module, next_tile).max()
            error = reward + future - q[action]
            q_of.learn(module, tile, action, error)
        row = (angle, velocity, action, reward, error, fell)
        for name, value in zip(columns, row, strict=True):
            columns[name].append(value)
        angle, velocity = new_angle, new_velocity
    for name in ("reward", "td_error"):
        columns[name] = list(np.array(columns[name]) / SCALE[readings.reward_unit] ** 2)
    return columns


def begin(spec: Spec, starts: np.random.Generator) -> tuple[float, float]:
    """A start state."""
    widest = np.radians(20) if spec.task.kind == "balancing" else np.pi
    angle = widest * (2 * starts.random() - 1)
    spin = 2 * (2 * starts.random() - 1)
    return angle, spin if spec.readings.start_velocity == "random" else 0.0


def move(spec: Spec, angle: float, velocity: float, cart: float) -> tuple[float, float]:
    """Equations 13–23 with the constants of §4.2.2."""
    own = spec.task.pendulum
    m, length, dt, g, friction = own.mass, own.length, own.time_step, own.gravity, own.friction
    sign = -1 if spec.readings.zero_of_angle == "hanging" else 1
    # The last digit decides where a long run goes; test_elementary.py holds it against the C library.
    sine, cosine = sine_and_cosine(angle)
    gravity_torque = sign * (m * g * length / 2) * sine
    cart_torque = sign * (m * length / 2) * cart * cosine
    moment_of_inertia = m * length * length / 3
    acceleration = (gravity_torque + cart_torque + -velocity * friction) / moment_of_inertia
    return angle + velocity * dt + acceleration * dt * dt, velocity + acceleration * dt


def code(spec: Spec, angle: float, velocity: float) -> tuple[int, int]:
    """(module, tile), from the edges of the tiles."""
    pi = np.pi / 2 if spec.readings.angle_unit == "half_turn" else np.pi
    column = int(np.clip(np.searchsorted(np.arange(-20, 21, 2), velocity, "right") - 1, 0, 19))
    if spec.architecture.is_modular:
        if -np.pi / 2 <= angle < np.pi / 2:
            return 0, int(bin_of(angle, np.linspace(-pi, pi, 5))) * 20 + column
        if angle < 0:
            return 1, int(bin_of(angle, np.linspace(-2 * pi, -pi, 3))) * 20 + column
        return 1, (2 + int(bin_of(angle, np.linspace(pi, 2 * pi, 3)))) * 20 + column
    parts, widest = (4, pi) if spec.task.kind == "balancing" else (8, 2 * pi)
    return 0, int(bin_of(angle, np.linspace(-widest, widest, parts + 1))) * 20 + column


def bin_of(value: float, edges: NDArray[Any]) -> int:
    """Which bin a value is in; the outer ones catch the rest."""
    return int(np.clip(np.searchsorted(edges, value, "right") - 1, 0, len(edges) - 2))


class TableOrControl:
    """Eq. 12, or nothing."""

    sign = 1.0

    def __init__(self, spec: Spec, learned: dict[str, NDArray[Any]]) -> None:
        self.spec, self.learned = spec, learned

    def __call__(self, module: int, tile: int) -> NDArray[Any]:
        if "preference" in self.learned:
            return self.learned["preference"]
        return self.learned["q"][module, tile].copy()

    def learn(self, module: int, tile: int, action: int, error: float) -> None:
        if self.spec.alpha is not None:
            self.learned["q"][module, tile, action] += self.spec.alpha * error


class Networks:
    """Backpropagation of the error signal α·δ through dense layers."""

    def __init__(self, spec: Spec, learned: dict[str, NDArray[Any]]) -> None:
        self.spec, self.learned = spec, learned
        self.depth = len(spec.architecture.hidden) + 1
        self.sign = -1.0 if spec.readings.error_sign == "printed" else 1.0

    def layers(self, module: int, tile: int, action: int) -> list[NDArray[Any]]:
        signals = [np.eye(self.learned["weights.0"].shape[2])[tile]]
        for k in range(self.depth):
            potential = self.matrix(k, module, action) @ signals[-1]
            if f"biases.{k}" in self.learned:
                potential = potential + self.learned[f"biases.{k}"][module, action]
            signals.append(potential if k == self.depth - 1 else expit(potential))
        return signals

    def matrix(self, k: int, module: int, action: int) -> NDArray[Any]:
        weights = self.learned[f"weights.{k}"][module, action]
        return weights.T if k == 0 else weights  # a view: learning changes what was given

    def __call__(self, module: int, tile: int) -> NDArray[Any]:
        return np.array(
            [
                self.layers(module, tile, action)[-1][0]
                for action in range(self.learned["weights.0"].shape[1])
            ]
        )

    def learn(self, module: int, tile: int, action: int, error: float) -> None:
        assert self.spec.alpha is not None
        signals = self.layers(module, tile, action)
        delta = np.array([float(self.spec.readings.learning_rate) * self.spec.alpha * error])
        for k in reversed(range(self.depth)):
            weights = self.matrix(k, module, action)
            below = weights.T @ delta
            weights += np.outer(delta, signals[k])
            if f"biases.{k}" in self.learned:
                self.learned[f"biases.{k}"][module, action] += delta
            delta = below * signals[k] * (1 - signals[k])
