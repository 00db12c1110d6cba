"""Q-learning, line for line as in §3.1.3 (and §3.2.2 for networks), for every learner and coding."""

from math import nan
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing import pendulum, tasks
from upswing.compiled import compiled
from upswing.learners import Array, update, values
from upswing.pendulum import Pendulum
from upswing.policy import epsilon_greedy
from upswing.tasks import ACCELERATIONS, Task
from upswing.tiles import Tiles, locate

Column = NDArray[np.float32]

RESET_FALLEN, RESET_TERMINAL, RESET_START = 0, 1, 2  # R7
OWNER, OWN, TERMINAL = 0, 1, 2  # R14
NOTHING_OPEN = -1


class Rule(NamedTuple):
    """The update rule and the policy."""

    step_size: float  # α
    discount: float  # γ
    bootstrap_sign: float  # −1 under R13 `printed`, else 1
    reward_scale: float  # from rad² into R3's unit
    epsilon: float  # the share of random actions
    random_ties: bool  # R6
    reset: int  # R7
    hand_over: int  # R14


class State(NamedTuple):
    """Where the system is."""

    angle: float  # φ [rad]
    angular_velocity: float  # φ̇ [rad/s]
    cart_position: float  # x [m]
    cart_velocity: float  # ẋ [m/s]


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


class Open(NamedTuple):
    """Updates a module left open when it handed over (R14 `own`), by module."""

    step: NDArray[np.int64]  # when it was; NOTHING_OPEN
    tile: NDArray[np.int64]
    action: NDArray[np.int64]
    reward: Array


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


def nothing_open(modules: int) -> Open:
    """No update left open."""
    step, tile, action = (np.full(modules, NOTHING_OPEN, dtype=np.int64) for _ in range(3))
    return Open(step, tile, action, np.zeros(modules))


@compiled
def learn(
    body: Pendulum,
    task: Task,
    tiles: Tiles,
    learner: NamedTuple,
    rule: Rule,
    state: State,
    open_: Open,
    actions: np.random.Generator,
    starts: np.random.Generator,
    trajectory: Trajectory,
    first: int,
    last: int,
) -> State:
    """Learn from step ``first`` up to ``last``, recording every step; returns where the system is.

    A run may be learned in several calls: the same trajectory as in one. ``learner``, ``open_``,
    the two streams of random numbers and ``trajectory`` are changed in place.
    """
    # Observe starting state s
    angle, angular_velocity, cart_position, cart_velocity = state
    module, tile = locate(tiles, angle, angular_velocity)
    # Repeat:
    for t in range(first, last):
        q = values(learner, module, tile)
        if open_.step[module] != NOTHING_OPEN:
            td_error = close(learner, rule, open_, module, max(q))
            trajectory.td_error[open_.step[module]] = td_error / rule.reward_scale
            open_.step[module] = NOTHING_OPEN
            q = values(learner, module, tile)

        # Choose a from s using policy derived from Q
        action = epsilon_greedy(q, rule.epsilon, rule.random_ties, actions.random())

        # Take action a, observe r, s′
        acceleration = ACCELERATIONS[action]
        next_angle, next_angular_velocity = pendulum.step(
            body, angle, angular_velocity, acceleration
        )
        next_cart_position, next_cart_velocity = pendulum.step_cart(
            body, cart_position, cart_velocity, acceleration
        )
        if task.wraps:
            next_angle = tasks.wrapped(next_angle)
        fell = tasks.fallen(task, next_angle)
        observed_angle, observed_velocity = next_angle, next_angular_velocity
        if fell:
            next_angle, next_angular_velocity = tasks.start(task, starts)
            next_cart_position, next_cart_velocity = 0.0, 0.0
            if rule.reset == RESET_START:
                observed_angle, observed_velocity = next_angle, next_angular_velocity
        reward = tasks.reward(observed_angle if task.rewards_next else angle)
        next_module, next_tile = locate(tiles, observed_angle, observed_velocity)

        # Q(s, a) ← Q(s, a) + α [r + γ max Q(s′, a′) − Q(s, a)]   (eq. 12; eq. 11 with α = 1)
        ended = fell and rule.reset == RESET_TERMINAL
        handed_over = next_module != module
        if handed_over and rule.hand_over == OWN and not ended:
            open_.step[module], open_.tile[module] = t, tile
            open_.action[module], open_.reward[module] = action, reward
            td_error = nan
        else:
            if ended or (handed_over and rule.hand_over == TERMINAL):
                bootstrap = 0.0
            else:
                next_q = values(learner, next_module, next_tile)
                bootstrap = rule.bootstrap_sign * rule.discount * max(next_q)
            td_error = rule.reward_scale * reward + bootstrap - q[action]
            update(learner, module, tile, action, rule.step_size * td_error)

        trajectory.angle[t] = angle
        trajectory.angular_velocity[t] = angular_velocity
        trajectory.cart_position[t] = cart_position
        trajectory.cart_velocity[t] = cart_velocity
        trajectory.action[t] = action
        trajectory.reward[t] = reward
        trajectory.td_error[t] = td_error / rule.reward_scale
        trajectory.reset[t] = fell

        # s ← s′
        angle, angular_velocity = next_angle, next_angular_velocity
        cart_position, cart_velocity = next_cart_position, next_cart_velocity
        module, tile = next_module, next_tile
        if fell:
            module, tile = locate(tiles, angle, angular_velocity)
    return State(angle, angular_velocity, cart_position, cart_velocity)


@compiled
def close(learner: NamedTuple, rule: Rule, open_: Open, module: int, next_value: float) -> float:
    """Do the update that ``module`` left open, now that it is in control again; returns δ."""
    tile, action = open_.tile[module], open_.action[module]
    q = values(learner, module, tile)
    bootstrap = rule.bootstrap_sign * rule.discount * next_value
    td_error: float = rule.reward_scale * open_.reward[module] + bootstrap - q[action]
    update(learner, module, tile, action, rule.step_size * td_error)
    return td_error
