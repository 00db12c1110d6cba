"""The pendulum on its cart: equations 13–25 of §4.2, with the constants of §4.2.2.

Two slips of the text are kept in mind here. Equations 13 and 15 measure the angle from the hanging
position, while reward, start and reset of §4.4–4.5 have it zero upright (reading R1); from upright,
gravity and the cart's torque change sign. Velocities are printed in m/s where they are rad/s.
"""

from typing import Any, NamedTuple

from upswing.physics.elementary import sine_and_cosine
from upswing.physics.jit import ByType, compiled
from upswing.study.physical import PendulumOptions

FROM_UPRIGHT = 1.0
FROM_HANGING = -1.0


LEFT, NONE, RIGHT = -10.0, 0.0, 10.0


class ThesisActions(NamedTuple):
    """ẍ of the actions of §4.4 [m/s²], known while the loop is compiled: choosing one costs no jump."""

    left: float = LEFT
    none: float = NONE
    right: float = RIGHT


class Pendulum(NamedTuple):
    """The constants of §4.2.2, and what the actions do to the cart (§4.4)."""

    mass: float = 0.1  # m [kg]
    length: float = 0.2  # l [m]
    gravity: float = 9.81  # g [m/s²]
    friction: float = 0.001  # f_c [N·m·s]: the torque is −f_c·φ̇ (eq. 17), so friction is viscous
    time_step: float = 0.005  # dt [s]
    orientation: float = FROM_UPRIGHT  # where φ = 0 is (R1); FROM_HANGING is eq. 13 as printed
    accelerations: tuple[float, ...] = ThesisActions()  # ẍ of each action [m/s²], ascending


def body_of(options: PendulumOptions, orientation: float = FROM_UPRIGHT) -> Pendulum:
    """The pendulum of a task."""
    accelerations = tuple(map(float, options.accelerations))
    return Pendulum(
        mass=float(options.mass),
        length=float(options.length),
        gravity=float(options.gravity),
        friction=float(options.friction),
        time_step=float(options.time_step),
        orientation=orientation,
        accelerations=ThesisActions() if accelerations == ThesisActions() else accelerations,
    )


def _acceleration_of(accelerations: Any, action: int) -> float:
    acceleration: float = accelerations[action]
    return acceleration


_acceleration_by_type = ByType(_acceleration_of)
acceleration_of = _acceleration_by_type.call
"""ẍ [m/s²] of an action, an index into a pendulum's ``accelerations``."""


@_acceleration_by_type.register(ThesisActions)
def _acceleration_of_thesis(_accelerations: ThesisActions, action: int) -> float:
    return (LEFT, NONE, RIGHT)[action]


@compiled
def angular_acceleration(
    pendulum: Pendulum, angle: float, angular_velocity: float, cart_acceleration: float
) -> float:
    """φ̈ [rad/s²] at φ [rad], φ̇ [rad/s] and ẍ [m/s²] (eq. 21)."""
    m, l, g, f_c, _, up, _ = pendulum  # noqa: E741  the symbols of §4.2
    sin_angle, cos_angle = sine_and_cosine(angle)
    gravity_torque = up * (m * g * l / 2) * sin_angle  # M_P, eq. 14
    cart_torque = up * (m * l / 2) * cart_acceleration * cos_angle  # M_C, eq. 16
    friction_torque = -f_c * angular_velocity  # M_Fr, eq. 17
    moment_of_inertia = m * l * l / 3  # J, eq. 19
    return (gravity_torque + cart_torque + friction_torque) / moment_of_inertia  # eq. 18, 20


@compiled
def step(
    pendulum: Pendulum, angle: float, angular_velocity: float, cart_acceleration: float
) -> tuple[float, float]:
    """φ [rad] and φ̇ [rad/s] one time step later (eq. 22, 23).

    Equation 22 carries dt² without the ½. With equation 23 that is φ + φ̇(t+dt)·dt: the
    semi-implicit (symplectic) Euler method, of first order in dt.
    """
    dt = pendulum.time_step
    acceleration = angular_acceleration(pendulum, angle, angular_velocity, cart_acceleration)
    next_angle = angle + angular_velocity * dt + acceleration * dt * dt
    next_angular_velocity = angular_velocity + acceleration * dt
    return next_angle, next_angular_velocity


@compiled
def step_cart(
    pendulum: Pendulum, position: float, velocity: float, acceleration: float
) -> tuple[float, float]:
    """X [m] and ẋ [m/s] of the cart one time step later (eq. 24, 25); the track is infinite."""
    dt = pendulum.time_step
    next_position = position + velocity * dt + acceleration * dt * dt
    next_velocity = velocity + acceleration * dt
    return next_position, next_velocity


@compiled
def jerk(pendulum: Pendulum, angle: float, change: float) -> float:
    """What a sudden ``change`` of ẋ [m/s] adds to φ̇ [rad/s]: eq. 20 over so short a time, M_C alone."""
    m, l, _, _, _, up, _ = pendulum  # noqa: E741  the symbols of §4.2
    _, cos_angle = sine_and_cosine(angle)
    return up * (m * l / 2) * change * cos_angle / (m * l * l / 3)


@compiled
def energy(pendulum: Pendulum, angle: float, angular_velocity: float) -> float:
    """Kinetic and potential energy [J] on a cart at rest; that of the horizontal at rest is zero."""
    m, l, g, _, _, up, _ = pendulum  # noqa: E741  the symbols of §4.2
    _, cos_angle = sine_and_cosine(angle)
    return (
        m * l * l / 3 * angular_velocity * angular_velocity / 2 + up * (m * g * l / 2) * cos_angle
    )
