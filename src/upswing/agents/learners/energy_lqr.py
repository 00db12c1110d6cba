"""Control theory's answer to full control: energy swings the pendulum up, a linear regulator catches it.

Far from upright the cart pushes so that the energy approaches that of rest upright (Åström and Furuta,
2000). Near it the push is linear in φ and φ̇. The two factors are those that cost least in the long run
where a step costs φ² + ``effort``·ẍ² (the linear-quadratic regulator): the thesis's own −r, and a price
of pushing. Both follow from the task's own pendulum.
"""

from math import floor, pi, radians
from typing import ClassVar, NamedTuple

import numpy as np
from pydantic import Field
from scipy.linalg import solve_discrete_are

from upswing.agents.controller import ControllerLearner, nearness
from upswing.agents.features import Point
from upswing.agents.learners import Array, Beginning, values_of
from upswing.agents.policy import Q
from upswing.physics.elementary import sine_and_cosine
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum, energy
from upswing.study.controller import ControllerOptions
from upswing.study.values import Positive

EASED = 0.1
"""Where less is missing than this share of what upright and hanging differ by, the push eases off."""


class Options(ControllerOptions):
    """Where the regulator takes over, and what a push costs it."""

    computes_with: ClassVar[tuple[str, ...]] = ("scipy",)
    catch: Positive = Field(
        default=45.0, le=90, description="Within ± this of upright the regulator is in control [°]."
    )
    effort: Positive = Field(
        default=1e-4,
        description="What a push costs the regulator beside φ² [rad² per (m/s²)²]; the less, the harder "
        "it pushes.",
    )

    def in_words(self) -> str:
        """For a reader of the page."""
        return (
            f"a linear-quadratic regulator within {self.catch:g}° of upright, and elsewhere a law that "
            "gives the pendulum the energy to get there"
        )


class EnergyLqr(NamedTuple):
    """The pendulum that it knows, and the regulator."""

    gain: Array  # (2,): ẍ per φ [m/s² per rad] and per φ̇ [m/s per rad]; the push is minus this
    body: Pendulum
    catch: float  # [rad]
    strongest: float  # the largest acceleration [m/s²]
    accelerations: tuple[float, ...]  # of the actions [m/s²]


def linear(body: Pendulum) -> tuple[Array, Array]:
    """One time step near φ = 0: (φ, φ̇) ← A (φ, φ̇) + B ẍ, from equations 21 to 23; (2, 2) and (2, 1)."""
    inertia = body.mass * body.length**2 / 3
    lever = body.orientation * body.mass * body.length / 2
    of_state = np.array([lever * body.gravity, -body.friction]) / inertia
    of_push = lever / inertia
    dt = body.time_step
    arrives = np.array([dt * dt, dt])  # φ̈ in φ and in φ̇
    a = np.array([[1.0, dt], [0.0, 1.0]]) + np.outer(arrives, of_state)
    return a, arrives[:, None] * of_push


def regulator(body: Pendulum, effort: float) -> Array:
    """The factors of φ and φ̇, (2,), that cost least: from scipy's solution of the Riccati equation."""
    a, b = linear(body)
    price = np.array([[effort]])
    p = solve_discrete_are(a, b, np.diag([1.0, 0.0]), price)
    gain: Array = np.linalg.solve(price + b.T @ p @ b, b.T @ p @ a)[0]
    return gain


@compiled
def law(controller: EnergyLqr, angle: float, angular_velocity: float) -> float:
    """The acceleration that it wants [m/s²]."""
    body = controller.body
    from_zero = angle - 2 * pi * floor(angle / (2 * pi) + 0.5)  # within half a turn
    if abs(from_zero) <= controller.catch:
        return -float(controller.gain[0] * from_zero + controller.gain[1] * angular_velocity)
    rest, hanging = energy(body, 0.0, 0.0), energy(body, pi, 0.0)
    missing = (rest - energy(body, angle, angular_velocity)) / abs(rest - hanging)
    _, cos_angle = sine_and_cosine(angle)
    # The energy grows by φ̇·M_C, where M_C has the sign of ẍ cos φ (eq. 16); at rest, push it anyhow.
    gains = body.orientation * angular_velocity * cos_angle >= 0.0
    push = controller.strongest * min(1.0, max(-1.0, missing / EASED))
    return push if gains else -push


@values_of(EnergyLqr)
def _values(controller: EnergyLqr, point: Point) -> Q:
    return nearness(controller.accelerations, law(controller, point.angle, point.angular_velocity))


def create(beginning: Beginning) -> ControllerLearner:
    """The controller of the task's pendulum."""
    body, options = beginning.body, beginning.options
    controller = EnergyLqr(
        gain=regulator(body, options["effort"]),
        body=body,
        catch=radians(options["catch"]),
        strongest=max(map(abs, body.accelerations)),
        accelerations=tuple(body.accelerations),
    )
    return ControllerLearner(controller, {"gain": controller.gain})
