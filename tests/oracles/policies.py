"""Learners of policies as their sources print them: whole vectors and whole episodes, in numpy."""

import numpy as np
from scipy.special import softmax
from scipy.stats import norm

from tests.oracles.textbook import World


def _drawn(world, preferences):
    return int(
        np.searchsorted(np.cumsum(softmax(preferences))[:-1], world.actions.random(), "right")
    )


def _learn(preferences, v, s, a, error, alpha, rate):
    """∇ ln π of a softmax over the row of s: the unit vector of a, less all probabilities."""
    preferences[s] += rate * alpha * error * (np.eye(3)[a] - softmax(preferences[s]))
    v[s] += alpha * error


def actor_critic(kind, seed, steps, alpha, rate, discount):
    """One-step actor-critic on tiles; the fallen state counts as any other (R7)."""
    world, preferences, v, taken = World(kind, seed), np.zeros((160, 3)), np.zeros(160), []
    for _ in range(steps):
        s = world.tile(world.state)
        a = _drawn(world, preferences[s])
        taken.append(a)
        r, seen, _ = world.act(a)
        _learn(preferences, v, s, a, r + discount * v[seen] - v[s], alpha, rate)
    return taken, preferences, v


def reinforce(kind, seed, steps, alpha, rate, discount, horizon):
    """REINFORCE with a baseline: an episode's returns when it ends, or after ``horizon`` steps."""
    world, preferences, v, taken = World(kind, seed), np.zeros((160, 3)), np.zeros(160), []
    episode = []
    for _ in range(steps):
        s = world.tile(world.state)
        a = _drawn(world, preferences[s])
        taken.append(a)
        r, _, fell = world.act(a)
        episode.append((s, a, r))
        while episode and (fell or len(episode) == horizon):
            total = sum(discount**n * r for n, (_, _, r) in enumerate(episode))
            s, a, _ = episode.pop(0)
            _learn(preferences, v, s, a, total - v[s], alpha, rate)
    return taken, preferences, v


def ase_ace(seed, steps, box_of, boxes, kind="balancing", told_reward=False):
    """The two elements with the numbers of 1983: α = 1000, β = 0.5, δ = 0.9, λ = 0.8, σ = 0.01.

    They learn from failures, or (``told_reward``) from the reward of the thesis.
    """
    world, taken = World(kind, seed), []
    w, v, e, x_bar = np.zeros((4, boxes))
    p_before = None
    for _ in range(steps):
        x = np.zeros(boxes)
        x[box_of(world.state)] = 1
        if p_before is None:
            p_before = v @ x
        y = 1 if w @ x - 0.01 * norm.ppf(world.actions.random()) > 0 else -1
        taken.append(0 if y < 0 else 2)
        e, x_bar = e + (1 - 0.9) * y * x, x_bar + (1 - 0.8) * x
        reward, _, fell = world.act(taken[-1])
        x_next = np.zeros(boxes)
        x_next[box_of(world.state)] = 1
        p = 0 if fell else v @ x_next
        r = reward if told_reward else -1 if fell else 0
        r_hat = r + 0.95 * p - p_before
        w, v = w + 1000 * r_hat * e, v + 0.5 * r_hat * x_bar
        e, x_bar, p_before = (0 * e, 0 * x_bar, None) if fell else (0.9 * e, 0.8 * x_bar, p)
    return taken, w, v
