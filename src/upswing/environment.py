"""The system that is learned on, one step at a time: what the loop and every other agent share."""

from typing import NamedTuple

from upswing import pendulum, tasks
from upswing.compiled import inlined
from upswing.pendulum import Pendulum
from upswing.tasks import Task


class State(NamedTuple):
    """Where the system is."""

    angle: float  # φ [rad]
    angular_velocity: float  # φ̇ [rad/s]
    cart_position: float  # x [m]
    cart_velocity: float  # ẋ [m/s]


@inlined
def move(body: Pendulum, task: Task, state: State, acceleration: float) -> State:
    """Where the system is one time step later, with ẍ [m/s²]; what has fallen is not reset here."""
    angle, angular_velocity = pendulum.step(body, state.angle, state.angular_velocity, acceleration)
    cart_position, cart_velocity = pendulum.step_cart(
        body, state.cart_position, state.cart_velocity, acceleration
    )
    if task.wraps:
        angle = tasks.wrapped(angle)
    return State(angle, angular_velocity, cart_position, cart_velocity)
