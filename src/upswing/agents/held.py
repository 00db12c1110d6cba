"""Acting by a network of rectified linear units, on decisions that are held for several steps.

It is apart from the learner, so that what was compiled for it can be fetched without torch.
"""

from math import nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Point
from upswing.agents.learners import Array, values, values_of
from upswing.agents.learners.backpropagation.dense import inputs
from upswing.agents.policy import Q, Rule, epsilon_greedy
from upswing.physics.environment import State, record, transition
from upswing.physics.jit import compiled, with_item
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import Task


class DeepQ(NamedTuple):
    """The memory of the network, and room for its signals."""

    weights: tuple[NDArray[np.float32], ...]  # (outputs, inputs) of each layer
    biases: tuple[NDArray[np.float32], ...]  # (outputs,)
    unit: float  # of the network's Q, in R3's unit
    action_repeat: int  # number of steps that a decision is held
    signals: Array  # (layers + 1, widest)
    zeros: Q  # as many as there are actions


class Decision(NamedTuple):
    """The decision that is going on."""

    state: Array  # inputs of s: (INPUTS,)
    next_state: Array  # inputs of s′: (INPUTS,)
    sums: Array  # r₁ + γ r₂ + … so far, in R3's unit, and γᵏ so far: (2,)


@values_of(DeepQ)
def _values(net: DeepQ, point: Point) -> Q:
    signals, layers = net.signals, len(net.weights)
    signals[0, 0], signals[0, 1], signals[0, 2] = inputs(point)
    for layer in range(layers):
        weights, bias = net.weights[layer], net.biases[layer]
        told, answer = signals[layer], signals[layer + 1]
        is_last = layer == layers - 1
        for j in range(weights.shape[0]):
            potential = float(bias[j])
            for i in range(weights.shape[1]):
                potential += weights[j, i] * told[i]
            answer[j] = potential if is_last else max(potential, 0.0)
    q = net.zeros
    for action in range(len(q)):
        q = with_item(q, action, net.unit * signals[layers, action])
    return q


@compiled
def act(
    body: Pendulum, task: Task, net: DeepQ, rule: Rule, decision: Decision, state: State,
    actions: np.random.Generator, starts: np.random.Generator, trajectory: Any,
    first: int, last: int,
) -> tuple[State, int, bool, bool]:  # fmt: skip
    """Act from step ``first`` up to ``last``, recording all but what is learned.

    It decides every ``action_repeat`` steps and after a fall, and records and draws as ``loop.learn``
    does. Where something is to be learned it goes no further than to the end of a decision; with a step
    size of 0 it goes on, and leaves ``decision`` as it is.

    Returns:
        Where the system is, the step that is next, whether a decision was over, and whether nothing
        follows it (R7).
    """
    learns = rule.step_size > 0.0
    for t in range(first, last):
        draw = actions.random()
        if t % net.action_repeat == 0 or trajectory.reset[t - 1]:
            point = Point(0, state.angle, state.angular_velocity)
            action = epsilon_greedy(values(net, point), rule.epsilon, rule.random_ties, draw)
            if learns:
                now = decision.state
                now[0], now[1], now[2] = inputs(point)
                decision.sums[0], decision.sums[1] = 0.0, 1.0
        else:
            action = int(trajectory.action[t - 1])

        taken = transition(body, task, rule.discount, state, action, starts)
        record(trajectory, t, state, action, taken, nan)
        state = taken.after
        if learns:
            decision.sums[0] += decision.sums[1] * rule.reward_scale * taken.told
            decision.sums[1] *= rule.discount
            if taken.fell or (t + 1) % net.action_repeat == 0:
                after = decision.next_state
                after[0], after[1], after[2] = inputs(
                    Point(0, taken.seen.angle, taken.seen.angular_velocity)
                )
                return state, t + 1, True, taken.terminal
    return state, last, False, False
