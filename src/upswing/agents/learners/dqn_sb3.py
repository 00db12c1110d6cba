"""Stable-Baselines3's deep Q-network in the study, to hold our own, ``dqn.py``, against.

The library has the network, its replay memory, its target network, its optimiser and how it learns from
them. The study acts and explores, and records every step, as with every other learner; the compiled
part acts with the network's own memory.

It decides every ``action_repeat`` steps and after a fall, and learns from decisions; the environment
knows nothing of that. A decision is held for k ≤ ``action_repeat`` steps (fewer around a fall). Its
reward is r₁ + γ r₂ + … + γᵏ⁻¹ rₖ, and what follows counts γ^``action_repeat``, whatever k: the library
has one discount.

A run is the same again on the same machine; torch's sums may differ from processor to processor.
"""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar, cast

import gymnasium
import numpy as np
import torch
from numpy.typing import NDArray
from stable_baselines3 import DQN
from stable_baselines3.common.buffers import ReplayBuffer
from stable_baselines3.common.logger import Logger
from stable_baselines3.common.type_aliases import ReplayBufferSamples
from stable_baselines3.common.utils import polyak_update
from torch import Tensor, nn

from upswing.agents.features import Point
from upswing.agents.held import Decision, DeepQ, act
from upswing.agents.learners import Array, Beginning
from upswing.agents.learners.backpropagation.dense import INPUTS, inputs
from upswing.agents.policy import Rule
from upswing.physics.environment import NEVER, State
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import Task
from upswing.study.deep_q import DeepQOptions


class Options(DeepQOptions):
    """The size of the network, and how it learns."""

    computes_with: ClassVar[tuple[str, ...]] = ("stable-baselines3",)


class Spaces(gymnasium.Env[NDArray[np.float32], np.int64]):
    """What the network is told, and how many actions it has; the study moves the system."""

    def __init__(self, actions: int) -> None:
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (INPUTS,), np.float32)
        self.action_space = gymnasium.spaces.Discrete(actions)


class Replay(ReplayBuffer):
    """The library's replay memory, but a run's own stream draws from it; and the last minibatch."""

    def __init__(self, *args: Any, draws: np.random.Generator, **options: Any) -> None:
        super().__init__(*args, **options)
        self.draws = draws

    def sample(self, batch_size: int, env: Any = None) -> ReplayBufferSamples:
        """Decisions that are remembered, each drawn by itself."""
        self.drawn = self._get_samples(self.draws.integers(self.size(), size=batch_size), env)
        return self.drawn


class DqnLearner:
    """The library's agent, and the decision that is going on."""

    epsilon = None

    def __init__(self, model: DQN, replay: Replay, unit: float, options: Mapping[str, Any]) -> None:
        torch.set_num_threads(1)  # its matrices are small
        self.model, self.replay = model, replay
        self.unit = np.array(unit)
        self.batch_size = int(options["batch_size"])
        self.learning_starts = int(options["learning_starts"])
        self.update_interval = int(options["update_interval"])
        self.target_update_interval = int(options["target_update_interval"])
        self.over_at = self.updates = 0  # the step before which the last decision was over
        layers = [layer for layer in model.q_net.q_net if isinstance(layer, nn.Linear)]
        self.stepped = DeepQ(
            tuple(layer.weight.detach().numpy() for layer in layers),
            tuple(layer.bias.detach().numpy() for layer in layers),
            unit,
            int(options["action_repeat"]),
            np.zeros((len(layers) + 1, max(max(layer.weight.shape) for layer in layers))),
            (0.0,) * layers[-1].out_features,
        )
        self.decision = Decision(np.zeros(INPUTS), np.zeros(INPUTS), np.zeros(2))
        # What both networks say while the library learns is all that shows its errors.
        self.said: dict[nn.Module, Tensor] = {}
        for network in (model.q_net, model.q_net_target):
            network.register_forward_hook(self._hear)

    def _hear(self, network: nn.Module, _inputs: Any, said: Tensor) -> None:
        self.said[network] = said.detach()

    @property
    def learned(self) -> Mapping[str, NDArray[Any]]:
        """The network's ``state_dict``, and the unit of its Q."""
        weights = self.model.q_net.state_dict()
        return {"unit": self.unit, **{name: tensor.numpy() for name, tensor in weights.items()}}

    def action_values(self, places: Sequence[Point]) -> Array:
        """Q at ``places``, through the library's network."""
        states = torch.tensor([inputs(point) for point in places], dtype=torch.float32)
        with torch.no_grad():
            return np.asarray(self.unit * self.model.q_net(states).numpy().astype(np.float64))

    def advance(
        self, body: Pendulum, task: Task, _encoder: Any, stepped: DeepQ, _algorithm: Any, rule: Rule,
        state: State, actions: np.random.Generator, starts: np.random.Generator,
        trajectory: Any, first: int, last: int,
    ) -> State:  # fmt: skip
        """What ``loop.learn`` does, with the library's way to learn.

        Where it learned, ``td_error`` is the δ of the minibatch's first decision; elsewhere NaN. With
        a step size of 0 it only acts. A piece goes on with the action of ``trajectory`` before it.
        """
        if first == 0:
            trajectory.diverged_at[0] = NEVER
        at = first
        while True:
            state, at, is_over, is_terminal = act(
                body, task, stepped, rule, self.decision, state, actions, starts, trajectory, at, last
            )  # fmt: skip
            if is_over:
                self.remember(int(trajectory.action[at - 1]), is_terminal)
                is_time = at // self.update_interval > self.over_at // self.update_interval
                self.over_at = at
                if is_time and at >= self.learning_starts and trajectory.diverged_at[0] == NEVER:
                    errors = self.update(rule)
                    trajectory.td_error[at - 1] = errors[0] / rule.reward_scale
                    if not np.isfinite(errors).all():  # as in ``loop.learn``: it learns no more
                        trajectory.diverged_at[0] = at - 1
            if at == last:
                return state

    def remember(self, action: int, is_terminal: bool) -> None:
        """Put the decision that is over into the library's memory."""
        decision = self.decision
        self.replay.add(
            decision.state[None],
            decision.next_state[None],
            np.array([action]),
            decision.sums[:1] / self.unit,
            np.array([is_terminal]),
            [{}],
        )

    def update(self, rule: Rule) -> Array:
        """Let the library learn from a minibatch; its δ in R3's unit, as they were before."""
        model = self.model
        model.lr_schedule = lambda _: rule.step_size
        model.gamma = rule.discount**self.stepped.action_repeat
        model.train(gradient_steps=1, batch_size=self.batch_size)
        self.updates += 1
        drawn, said = self.replay.drawn, self.said
        best = said[model.q_net_target].amax(1, keepdim=True)
        wanted = drawn.rewards + (1 - drawn.dones) * model.gamma * best
        errors = wanted - said[model.q_net].gather(1, drawn.actions)
        if self.updates % self.target_update_interval == 0:
            polyak_update(model.q_net.parameters(), model.q_net_target.parameters(), model.tau)
        return np.asarray(self.unit * errors[:, 0].numpy().astype(np.float64))


def create(beginning: Beginning) -> DqnLearner:
    """An agent of the library with a network that begins as the library has it."""
    options, draws = beginning.options, beginning.weights
    # The library's random numbers are torch's own.
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(int(draws.integers(2**63)))
        model = DQN(
            "MlpPolicy",
            Spaces(beginning.actions),
            buffer_size=options["replay_capacity"],
            replay_buffer_class=Replay,
            replay_buffer_kwargs={"draws": draws},
            policy_kwargs={
                "net_arch": list(options["hidden"]),
                "optimizer_kwargs": {"fused": True},
            },
            device="cpu",
        )
    model.set_logger(Logger(folder=None, output_formats=[]))
    unit = -options["q_unit"] * beginning.lowest_q
    return DqnLearner(model, cast(Replay, model.replay_buffer), unit, options)
