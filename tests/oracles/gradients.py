"""Q-learning and Sarsa(λ) by torch's own gradients, and features by whole arrays."""

import numpy as np
import torch

from tests.oracles.textbook import World


class States(World):
    """A task whose states are told as they are."""

    def tile(self, state):
        return state.angle, state.angular_velocity


def distances(kind, angle, velocity):
    """How far a state is from the middle of each tile, in tiles of φ and of φ̇: (tiles,) each."""
    rows, limit = (4, np.pi / 2) if kind == "balancing" else (8, np.pi)
    centres, speeds = np.meshgrid(
        -limit + (np.arange(rows) + 0.5) * 2 * limit / rows, np.arange(-19.0, 20, 2), indexing="ij"
    )
    if kind == "balancing":
        away = np.clip(angle, -limit, limit) - centres
    else:  # the way round the circle
        away = np.angle(np.exp(1j * (angle - centres)))
    return (away / (2 * limit / rows)).ravel(), ((np.clip(velocity, -20, 20) - speeds) / 2).ravel()


def bells(kind, width):
    """x(s) of Gaussian features."""

    def features(angle, velocity):
        across, up = distances(kind, angle, velocity)
        return np.exp(-(across**2 + up**2) / (2 * width**2))

    return features


def circles(kind, radius):
    """x(s) of circles."""

    def features(angle, velocity):
        return (np.hypot(*distances(kind, angle, velocity)) < radius).astype(float)

    return features


def inputs(angle, velocity):
    """What networks are told of a state as it is."""
    return np.array([np.sin(angle), np.cos(angle), velocity / 20])


def q_learning(kind, seed, steps, forward, groups, discount=0.7, epsilon=0.01):
    """Semi-gradient Q-learning: each step is one of stochastic gradient descent on ½ δ².

    ``forward`` gives Q of a state as a tensor (actions,); ``groups`` are parameters with their step sizes.
    """
    world, optimiser, taken = States(kind, seed), torch.optim.SGD(groups, lr=0.0), []
    for _ in range(steps):
        state = world.tile(world.state)
        q = forward(*state)
        a = world.choose(q.tolist(), epsilon)
        taken.append(a)
        r, seen, _ = world.act(a)
        target = r + discount * forward(*seen).max().item()
        optimiser.zero_grad()
        (0.5 * (target - q[a]) ** 2).backward()
        optimiser.step()
    return taken


def sarsa_lambda(kind, seed, steps, forward, groups, trace, discount=0.7, epsilon=0.01):
    """Sarsa(λ) with a trace for every weight, which begins anew after a fall."""
    world, taken = States(kind, seed), []
    rates = [(p, group["lr"]) for group in groups for p in group["params"]]
    e = [torch.zeros_like(p) for p, _ in rates]
    s = world.tile(world.state)
    a = world.choose(forward(*s).tolist(), epsilon)
    for t in range(steps):
        taken.append(a)
        r, seen, fell = world.act(a)
        after = forward(*seen)
        if fell:
            next_value = after.max()
        elif t == steps - 1:  # it waits for an action that is never taken
            break
        else:
            next_a = world.choose(after.tolist(), epsilon)
            next_value = after[next_a]
        q = forward(*s)[a]
        delta = (r + discount * next_value - q).item()
        gradients = torch.autograd.grad(q, [p for p, _ in rates])
        with torch.no_grad():
            for i, ((p, rate), gradient) in enumerate(zip(rates, gradients, strict=True)):
                e[i] = discount * trace * e[i] + gradient
                p += rate * delta * e[i]
        if fell:
            e = [torch.zeros_like(one) for one in e]
            s = world.tile(world.state)
            a = world.choose(forward(*s).tolist(), epsilon)
        else:
            s, a = seen, next_a
    return taken
