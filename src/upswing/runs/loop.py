"""Q-learning, line for line as in §3.1.3 (and §3.2.2 for networks), for every learner and encoder."""

from math import isfinite, nan
from typing import Any, NamedTuple

import numpy as np

from upswing.agents.algorithms import Step, after_choice, before_choice, learn_from
from upswing.agents.features import locate
from upswing.agents.learners import choose, values
from upswing.agents.policy import Rule
from upswing.physics.environment import NEVER, State, Trajectory, record, transition
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import Task


@compiled
def learn(
    body: Pendulum,
    task: Task,
    encoder: Any,
    learner: NamedTuple,
    algorithm: NamedTuple,
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

    A run whose values overflow has diverged: ``trajectory.diverged_at`` says when it first met a state
    whose values are not all finite. It learns no more from there on; what it does then means nothing.
    With α = 0 nothing is learned either, and nothing remembered: δ is NaN.
    """
    td_errors = trajectory.td_error
    if first == 0:
        trajectory.diverged_at[0] = NEVER
    is_finite = trajectory.diverged_at[0] == NEVER
    learns = is_finite and rule.step_size > 0.0
    # Observe starting state s
    place = locate(encoder, state.angle, state.angular_velocity)
    # Repeat:
    for t in range(first, last):
        if learns:
            before_choice(algorithm, encoder, learner, rule, td_errors, place)

        # Choose a from s using policy derived from Q
        q = values(learner, place)
        if is_finite and not isfinite(sum(q)):
            trajectory.diverged_at[0] = t
            is_finite = learns = False
        action = choose(learner, q, rule, actions.random())
        if learns:
            after_choice(algorithm, encoder, learner, rule, td_errors, place, action)

        # Take action a, observe r, s′
        taken = transition(body, task, rule.discount, state, action, starts)
        seen, after = taken.seen, taken.after
        next_place = locate(encoder, seen.angle, seen.angular_velocity)

        # Q(s, a) ← Q(s, a) + α [r + γ max Q(s′, a′) − Q(s, a)]: algorithms/q_learning.py
        step = Step(
            t, state.angle, state.angular_velocity, place, q, action, rule.reward_scale * taken.told,
            next_place, taken.fell, taken.terminal,
        )  # fmt: skip
        td_error = learn_from(algorithm, encoder, learner, rule, td_errors, step) if learns else nan
        record(trajectory, t, state, action, taken, td_error / rule.reward_scale)

        # s ← s′
        state = after
        place = locate(encoder, after.angle, after.angular_velocity) if taken.fell else next_place
    return state
