"""A deep Q-network (Mnih et al., 2015), what came after the thesis: a yardstick for its networks.

One network of rectified linear units for all actions, learning by Adam from minibatches out of a
replay memory, towards a copy of itself that is renewed now and then. torch owns it and learns; the
compiled part acts with the same memory, and records what the loop of ``loop.py`` would.

It decides every ``action_repeat`` steps and after a fall, and learns from decisions; the environment
knows nothing of that. A decision is held for k ≤ ``action_repeat`` steps (fewer around a fall), and so
its target is r₁ + γ r₂ + … + γᵏ⁻¹ rₖ + γᵏ max Q(s′, a′): Q-learning of a semi-Markov problem, with the
study's γ.

A run is the same again on the same machine; torch's sums may differ from processor to processor.
"""

from collections.abc import Mapping, Sequence
from copy import deepcopy
from itertools import pairwise
from math import nan, sqrt
from typing import Any, NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from upswing.agents.features import Point
from upswing.agents.learners import Array, Beginning, values, values_of
from upswing.agents.learners.backpropagation.dense import INPUTS, inputs
from upswing.agents.policy import Q, Rule, epsilon_greedy
from upswing.agents.replay import Replay, begin, collect, empty_replay, end, sample
from upswing.physics.environment import NEVER, State, record, transition
from upswing.physics.jit import compiled, with_item
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import Task
from upswing.study.deep_q import DeepQOptions


class Options(DeepQOptions):
    """The size of the network, and how it learns."""


class QNetwork(nn.Module):
    """Layers of (inputs, outputs) weights and (outputs,) biases; rectified but for the last."""

    def __init__(self, sizes: tuple[int, ...], unit: float) -> None:
        super().__init__()
        shapes = list(pairwise(sizes))
        self.weights = nn.ParameterList(torch.zeros(s, dtype=torch.float64) for s in shapes)
        self.biases = nn.ParameterList(torch.zeros(s[1], dtype=torch.float64) for s in shapes)
        self.unit: Tensor
        self.register_buffer("unit", torch.tensor(unit, dtype=torch.float64))

    def forward(self, states: Tensor) -> Tensor:
        """Q [R3's unit, in units of ``unit``] of ``states`` (states, INPUTS): (states, actions)."""
        signal = states
        for layer, (weights, bias) in enumerate(zip(self.weights, self.biases, strict=True)):
            signal = torch.addmm(bias, signal if layer == 0 else torch.relu(signal), weights)
        return signal


class DeepQ(NamedTuple):
    """The memory of the network, and room for its signals."""

    weights: tuple[Array, ...]  # (inputs, outputs) of each layer
    biases: tuple[Array, ...]  # (outputs,)
    unit: float
    action_repeat: int  # number of steps that a decision is held
    signals: Array  # (layers + 1, widest)
    zeros: Q  # as many as there are actions


@values_of(DeepQ)
def _values(net: DeepQ, point: Point) -> Q:
    signals, layers = net.signals, len(net.weights)
    signals[0, 0], signals[0, 1], signals[0, 2] = inputs(point)
    for layer in range(layers):
        weights, bias = net.weights[layer], net.biases[layer]
        told, answer = signals[layer], signals[layer + 1]
        for j in range(bias.shape[0]):
            answer[j] = bias[j]
        for i in range(weights.shape[0]):
            signal = told[i]
            if layer == 0 or signal > 0.0:  # a rectified unit that is silent tells nothing
                for j in range(bias.shape[0]):
                    answer[j] += signal * weights[i, j]
    q = net.zeros
    for action in range(len(q)):
        q = with_item(q, action, net.unit * signals[layers, action])
    return q


@compiled
def act(
    body: Pendulum, task: Task, net: DeepQ, rule: Rule, replay: Replay, state: State,
    actions: np.random.Generator, starts: np.random.Generator, trajectory: Any,
    first: int, last: int,
) -> State:  # fmt: skip
    """Act from step ``first`` up to ``last``, recording all but what is learned.

    It records and draws as ``loop.learn`` does. With a step size of 0 nothing is remembered.
    """
    remembers = rule.step_size > 0.0
    for t in range(first, last):
        draw = actions.random()
        if t % net.action_repeat == 0 or trajectory.reset[t - 1]:
            point = Point(0, state.angle, state.angular_velocity)
            action = epsilon_greedy(values(net, point), rule.epsilon, rule.random_ties, draw)
            if remembers:
                begin(replay, point)
        else:
            action = int(trajectory.action[t - 1])

        taken = transition(body, task, rule.discount, state, action, starts)
        if remembers:
            collect(replay, rule.reward_scale * taken.told, rule.discount)
            if taken.fell or (t + 1) % net.action_repeat == 0:
                seen = Point(0, taken.seen.angle, taken.seen.angular_velocity)
                end(replay, action, seen, taken.terminal)
        record(trajectory, t, state, action, taken, nan)
        state = taken.after
    return state


class DqnLearner:
    """The network, its replay memory, its target and its optimiser."""

    epsilon = None

    def __init__(
        self, network: QNetwork, draws: np.random.Generator, options: Mapping[str, Any]
    ) -> None:
        torch.set_num_threads(1)  # its matrices are small
        self.network, self.target, self.draws = network, deepcopy(network), draws
        self.replay = empty_replay(options["replay_capacity"])
        self.optimiser = torch.optim.Adam(network.parameters(), fused=True)
        self.batch_size = int(options["batch_size"])
        self.learning_starts = int(options["learning_starts"])
        self.update_interval = int(options["update_interval"])
        self.target_update_interval = int(options["target_update_interval"])
        self.steps = self.updates = 0
        self.stepped = DeepQ(
            tuple(parameter.detach().numpy() for parameter in network.weights),
            tuple(parameter.detach().numpy() for parameter in network.biases),
            float(network.unit),
            int(options["action_repeat"]),
            np.zeros((len(network.weights) + 1, max(max(w.shape) for w in network.weights))),
            (0.0,) * network.weights[-1].shape[1],
        )

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """The network's ``state_dict``."""
        return {name: tensor.numpy() for name, tensor in self.network.state_dict().items()}

    def action_values(self, places: Sequence[Point]) -> Array:
        """Q at ``places``, through torch."""
        states = torch.tensor([inputs(point) for point in places], dtype=torch.float64)
        with torch.no_grad():
            return np.asarray((self.network.unit * self.network(states)).numpy())

    def advance(
        self, body: Pendulum, task: Task, _encoder: Any, stepped: DeepQ, _algorithm: Any, rule: Rule,
        state: State, actions: np.random.Generator, starts: np.random.Generator,
        trajectory: Any, first: int, last: int,
    ) -> State:  # fmt: skip
        """What ``loop.learn`` does, with the learner's own way to learn.

        Where it learned, ``td_error`` is the δ of the minibatch's first decision; elsewhere NaN. With
        a step size of 0 it only acts. A piece goes on with the action of ``trajectory`` before it.
        """
        if first == 0:
            trajectory.diverged_at[0] = NEVER
        learns = rule.step_size > 0.0
        every = self.update_interval
        pauses = range(first + every - self.steps % every, last, every)
        for to in (*pauses, last) if learns else (last,):
            state = act(
                body, task, stepped, rule, self.replay, state, actions, starts, trajectory, first, to
            )  # fmt: skip
            if learns and to > first:
                self.steps += to - first
                is_time = self.steps % every == 0 and self.steps >= self.learning_starts
                if is_time and trajectory.diverged_at[0] == NEVER:
                    rows = sample(self.replay, self.batch_size, self.draws)
                    errors = self.update(rows, rule.step_size)
                    trajectory.td_error[to - 1] = errors[0] / rule.reward_scale
                    if not np.isfinite(errors).all():  # as in ``loop.learn``: it learns no more
                        trajectory.diverged_at[0] = to - 1
            first = to
        return state

    def update(self, rows: NDArray[np.int64], step_size: float) -> Array:
        """Learn from these decisions; their δ in R3's unit, as they were before."""
        states, chosen, rewards, next_states, discounts = (
            torch.from_numpy(column[rows]) for column in self.replay[:5]
        )
        unit = self.network.unit
        with torch.no_grad():
            best = self.target(next_states).amax(1)
            wanted = rewards / unit + discounts * best
        q = self.network(states).gather(1, chosen[:, None])[:, 0]
        self.optimiser.param_groups[0]["lr"] = step_size
        self.optimiser.zero_grad()
        # Huber: an error beyond ±1 counts as ±1 (Mnih et al. clip it)
        nn.functional.smooth_l1_loss(q, wanted).backward()  # type: ignore[no-untyped-call]
        self.optimiser.step()
        self.updates += 1
        if self.updates % self.target_update_interval == 0:
            self.target.load_state_dict(self.network.state_dict())
        return np.asarray((unit * (wanted - q.detach())).numpy())


def create(beginning: Beginning) -> DqnLearner:
    """A network with weights and biases uniform in ± 1/√inputs, as is usual for these units."""
    sizes = (INPUTS, *beginning.options["hidden"], beginning.actions)
    network = QNetwork(sizes, -beginning.options["q_unit"] * beginning.lowest_q)
    with torch.no_grad():
        for weights, bias in zip(network.weights, network.biases, strict=True):
            for parameter in (weights, bias):
                draws = beginning.weights.uniform(-1, 1, tuple(parameter.shape))
                parameter.copy_(torch.from_numpy(draws / sqrt(weights.shape[0])))
    return DqnLearner(network, beginning.weights, beginning.options)
