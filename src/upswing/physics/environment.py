"""The system that is learned on, one step at a time: what the loop and every other agent share."""

from math import copysign
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.physics import pendulum, tasks, track
from upswing.physics.jit import inlined
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import Task

Column = NDArray[np.float32]


class State(NamedTuple):
    """Where the system is."""

    angle: float  # φ [rad]
    angular_velocity: float  # φ̇ [rad/s]
    cart_position: float  # x [m]
    cart_velocity: float  # ẋ [m/s]


class Transition(NamedTuple):
    """What followed an action."""

    after: State  # where the system is next: after a fall, at a new start
    seen: State  # s′, what the learner is told of it (R7)
    reward: float  # r_{t+1} [rad²] (§4.4)
    told: float  # the reward that is learned from [rad²]: r and what a task adds beyond the thesis
    fell: bool  # whether the action led to a fall, and so to a new start
    terminal: bool  # whether nothing follows s′ (R7)


class Trajectory(NamedTuple):
    """A whole run; row t holds s_t, a_t and what followed. Every array but the last: shape (steps,)."""

    angle: Column  # φ of s_t [rad]
    angular_velocity: Column  # φ̇ of s_t [rad/s]
    cart_position: Column  # x [m]
    cart_velocity: Column  # ẋ [m/s]
    action: NDArray[np.int8]  # index into the body's accelerations
    reward: Column  # r_{t+1} [rad²]
    td_error: Column  # δ [rad²]; NaN where nothing was learned
    reset: NDArray[np.bool_]  # whether a_t led to a fall and so to a new start
    diverged_at: NDArray[np.int64]  # the step at which a value was not finite; NEVER. Shape (1,)


NEVER = -1
"""What ``diverged_at`` is while every value is finite."""


def empty_trajectory(steps: int) -> Trajectory:
    """Room for a run of ``steps`` steps."""
    return Trajectory(
        angle=np.zeros(steps, dtype=np.float32),
        angular_velocity=np.zeros(steps, dtype=np.float32),
        cart_position=np.zeros(steps, dtype=np.float32),
        cart_velocity=np.zeros(steps, dtype=np.float32),
        action=np.zeros(steps, dtype=np.int8),
        reward=np.zeros(steps, dtype=np.float32),
        td_error=np.zeros(steps, dtype=np.float32),
        reset=np.zeros(steps, dtype=np.bool_),
        diverged_at=np.full(1, NEVER, dtype=np.int64),
    )


@inlined
def move(body: Pendulum, task: Task, state: State, acceleration: float) -> State:
    """Where the system is one time step later, with ẍ [m/s²]; what has fallen is not reset here."""
    angle, angular_velocity = pendulum.step(body, state.angle, state.angular_velocity, acceleration)
    cart_position, cart_velocity = pendulum.step_cart(
        body, state.cart_position, state.cart_velocity, acceleration
    )
    if track.at_end(task.track, cart_position):
        # The cart stops dead; the rod keeps what momentum it has about the joint.
        angular_velocity += pendulum.jerk(body, angle, -cart_velocity)
        cart_position, cart_velocity = copysign(task.track.limit, cart_position), 0.0
    if task.wraps:
        angle = tasks.wrapped(angle)
    return State(angle, angular_velocity, cart_position, cart_velocity)


@inlined
def transition(
    body: Pendulum,
    task: Task,
    discount: float,
    state: State,
    action: int,
    starts: np.random.Generator,
) -> Transition:
    """Take ``action``, an index into the body's accelerations; after a fall the run starts anew."""
    after = move(body, task, state, pendulum.acceleration_of(body.accelerations, action))
    seen = after
    fell = tasks.fallen(task, after.angle, after.cart_position)
    if fell:
        after = State(*tasks.start(task, starts), 0.0, 0.0)
        if task.reset == tasks.RESET_START:
            seen = after
    reward = tasks.reward(seen.angle if task.rewards_next else state.angle)
    told = reward + tasks.bonus(
        body, task, discount, state.angle, state.angular_velocity, seen.angle, seen.angular_velocity
    )
    terminal = fell and task.reset == tasks.RESET_TERMINAL
    return Transition(after, seen, reward, told, fell, terminal)


@inlined
def record(
    trajectory: Any, t: int, state: State, action: int, taken: Transition, td_error: float
) -> None:
    """Put step ``t`` into a ``Trajectory``; δ [rad²]."""
    trajectory.angle[t] = state.angle
    trajectory.angular_velocity[t] = state.angular_velocity
    trajectory.cart_position[t] = state.cart_position
    trajectory.cart_velocity[t] = state.cart_velocity
    trajectory.action[t] = action
    trajectory.reward[t] = taken.reward
    trajectory.td_error[t] = td_error
    trajectory.reset[t] = taken.fell
