"""Q-learning, line for line as in §3.1.3 (and §3.2.2 for networks), for every learner and coding."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing import tasks
from upswing.codings import locate
from upswing.compiled import compiled
from upswing.environment import State, move
from upswing.learners import values
from upswing.methods import Step, after_choice, before_choice, learn_from
from upswing.pendulum import Pendulum
from upswing.policy import Rule, epsilon_greedy
from upswing.tasks import ACCELERATIONS, Task

Column = NDArray[np.float32]


class Trajectory(NamedTuple):
    """A whole run; row t holds s_t, a_t and what followed. Every array has shape (steps,)."""

    angle: Column  # φ of s_t [rad]
    angular_velocity: Column  # φ̇ of s_t [rad/s]
    cart_position: Column  # x [m]
    cart_velocity: Column  # ẋ [m/s]
    action: NDArray[np.int8]  # index into ACCELERATIONS
    reward: Column  # r_{t+1} [rad²]
    td_error: Column  # δ [rad²]; NaN where nothing was learned
    reset: NDArray[np.bool_]  # whether a_t led to a fall and so to a new start


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
    )


@compiled
def learn(
    body: Pendulum,
    task: Task,
    coding: Any,
    learner: NamedTuple,
    method: NamedTuple,
    rule: Rule,
    state: State,
    actions: np.random.Generator,
    starts: np.random.Generator,
    trajectory: Trajectory,
    first: int,
    last: int,
) -> State:
    """Learn from step ``first`` up to ``last``, recording every step; returns where the system is.

    A run may be learned in several calls: the same trajectory as in one. ``learner``, ``method``,
    the two streams of random numbers and ``trajectory`` are changed in place.
    """
    td_errors = trajectory.td_error
    # Observe starting state s
    place = locate(coding, state.angle, state.angular_velocity)
    # Repeat:
    for t in range(first, last):
        before_choice(method, coding, learner, rule, td_errors, place)

        # Choose a from s using policy derived from Q
        q = values(learner, place)
        action = epsilon_greedy(q, rule.epsilon, rule.random_ties, actions.random())
        after_choice(method, coding, learner, rule, td_errors, place, action)

        # Take action a, observe r, s′
        after = move(body, task, state, ACCELERATIONS[action])
        seen = after
        fell = tasks.fallen(task, after.angle)
        if fell:
            after = State(*tasks.start(task, starts), 0.0, 0.0)
            if task.reset == tasks.RESET_START:
                seen = after
        next_place = locate(coding, seen.angle, seen.angular_velocity)
        reward = tasks.reward(seen.angle if task.rewards_next else state.angle)
        told = reward + tasks.bonus(
            body, task, rule.discount, state.angle, state.angular_velocity,
            seen.angle, seen.angular_velocity,
        )  # fmt: skip

        # Q(s, a) ← Q(s, a) + α [r + γ max Q(s′, a′) − Q(s, a)]: methods/q_learning.py
        step = Step(
            t, state.angle, state.angular_velocity, place, q, action, rule.reward_scale * told,
            next_place, fell, fell and task.reset == tasks.RESET_TERMINAL,
        )  # fmt: skip
        td_error = learn_from(method, coding, learner, rule, td_errors, step)

        trajectory.angle[t] = state.angle
        trajectory.angular_velocity[t] = state.angular_velocity
        trajectory.cart_position[t] = state.cart_position
        trajectory.cart_velocity[t] = state.cart_velocity
        trajectory.action[t] = action
        trajectory.reward[t] = reward
        trajectory.td_error[t] = td_error / rule.reward_scale
        trajectory.reset[t] = fell

        # s ← s′
        state = after
        place = locate(coding, after.angle, after.angular_velocity) if fell else next_place
    return state
