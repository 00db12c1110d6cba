"""The neighbours of Q-learning as textbooks print them: whole trace matrices, whole episodes, next actions first."""

import numpy as np

from upswing.agents.policy import epsilon_greedy
from upswing.physics.environment import State, move
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import create, fallen, reward, start
from upswing.runs.simulation import REWARD_SCALES, streams
from upswing.study.readings import Readings

SCALE = REWARD_SCALES["half_turn"]


class World:
    """A task of the thesis, coded in its tiles, under the default readings."""

    def __init__(self, kind, seed):
        self.kind, self.task = kind, create(kind, Readings())
        self.actions, self.starts, *_ = streams(seed)
        self.begin()

    def begin(self):
        self.state = State(*start(self.task, self.starts), 0.0, 0.0)

    def tile(self, state):
        rows, limit = (4, np.pi / 2) if self.kind == "balancing" else (8, np.pi)
        row = int(np.clip(np.floor((state.angle + limit) / (2 * limit / rows)), 0, rows - 1))
        column = int(np.clip(np.floor((state.angular_velocity + 20) / 2), 0, 19))
        return 20 * row + column

    def choose(self, q, epsilon):
        return epsilon_greedy(tuple(q), epsilon, True, self.actions.random())

    def act(self, action):
        """r, the tile of s′, whether it fell; s′ is the start of a new episode then."""
        after = move(Pendulum(), self.task, self.state, Pendulum().accelerations[action])
        fell = fallen(self.task, after.angle, after.cart_position)
        seen = self.tile(after)
        r = SCALE * reward(after.angle)
        self.state = after
        if fell:
            self.begin()
        return r, seen, fell


def sarsa(kind, seed, steps, alpha, discount=0.7, epsilon=0.01):
    """Sarsa with s, a, r, s′, a′; in a fallen state, where no action follows, the best one counts."""
    world, q, taken = World(kind, seed), np.zeros((160, 3)), []
    s = world.tile(world.state)
    a = world.choose(q[s], epsilon)
    for _ in range(steps):
        taken.append(a)
        r, seen, fell = world.act(a)
        if fell:
            q[s, a] += alpha * (r + discount * q[seen].max() - q[s, a])
            s = world.tile(world.state)
            a = world.choose(q[s], epsilon)
        else:
            next_a = world.choose(q[seen], epsilon)
            if len(taken) < steps:  # the last step waits for an action that is never taken
                q[s, a] += alpha * (r + discount * q[seen, next_a] - q[s, a])
            s, a = seen, next_a
    return taken, q


def q_lambda(kind, seed, steps, alpha, trace, discount=0.7, epsilon=0.01):
    """Watkins's Q(λ) with a trace for every state and action."""
    world, q, taken = World(kind, seed), np.zeros((160, 3)), []
    e = np.zeros_like(q)
    for _ in range(steps):
        s = world.tile(world.state)
        a = world.choose(q[s], epsilon)
        taken.append(a)
        if q[s, a] < q[s].max():
            e[:] = 0
        r, seen, fell = world.act(a)
        delta = r + discount * q[seen].max() - q[s, a]
        e[s, a] += 1
        q += alpha * delta * e
        e *= discount * trace
        if fell:
            e[:] = 0
    return taken, q


def monte_carlo(kind, seed, steps, alpha, horizon, discount=0.7, epsilon=0.01):
    """Every-visit Monte Carlo: an episode's returns when it ends, or after ``horizon`` steps."""
    world, q, taken = World(kind, seed), np.zeros((160, 3)), []
    episode = []
    for _ in range(steps):
        s = world.tile(world.state)
        a = world.choose(q[s], epsilon)
        taken.append(a)
        r, _, fell = world.act(a)
        episode.append((s, a, r))
        while episode and (fell or len(episode) == horizon):
            total = sum(discount**n * r for n, (_, _, r) in enumerate(episode))
            s, a, _ = episode.pop(0)
            q[s, a] += alpha * (total - q[s, a])
    return taken, q
