"""What V of a policy comes to on tiles: the mean of a tile's states, and what bootstrapping ends at.

A tile holds many states, and which of them a policy is in depends on how it came there: tiles are not
Markov. So methods that bootstrap end at other values than the mean, however much they see (§2.4.3).
"""

from typing import NamedTuple

import numpy as np

from upswing.agents.prediction import ENDED, Array, Experience, Whole
from upswing.physics.jit import compiled


class TileValues(NamedTuple):
    """V of the policy on the tiles that it visits; every array has shape (tiles,)."""

    share: Array  # of the steps that begin in the tile
    mean: Array  # of V over the states in which it is visited [rad²]
    spread: (
        float  # how far V of a state is from its tile's mean: root mean square over steps [rad²]
    )


def tile_values(experience: Experience, of_states: Array, tiles: int) -> TileValues:
    """The mean of ``of_states``, V of every s_t [rad²], in each tile."""
    mean = means(experience.tile, of_states, tiles)
    share = np.bincount(experience.tile, minlength=tiles) / len(experience.tile)
    spread = float(np.sqrt(np.mean((of_states - mean[experience.tile]) ** 2)))
    return TileValues(share, mean, spread)


def means(tile: Whole, of_states: Array, tiles: int) -> Array:
    """The mean in each tile, (tiles,); 0 where there is nothing."""
    visits = np.bincount(tile, minlength=tiles)
    total = np.bincount(tile, weights=of_states, minlength=tiles)
    mean: Array = total / np.maximum(visits, 1)
    return mean


def error(values: Array, truth: TileValues) -> Array:
    """How far values of tiles, (…, tiles), are from the truth: root mean square over steps [rad²]."""
    wrong: Array = np.sqrt(((values - truth.mean) ** 2 * truth.share).sum(axis=-1))
    return wrong


def returns(experience: Experience, discount: float) -> Array:
    """The discounted rewards from each step to the end of its episode, (steps,) [rad²]."""
    found = np.zeros(len(experience.reward))
    _return_from_last(experience, discount, found)
    return found


def first_visits(experience: Experience, tiles: int) -> Whole:
    """The steps in which an episode comes to a tile for the first time."""
    visit = experience.begun * tiles + experience.tile
    _, first = np.unique(visit, return_index=True)
    found: Whole = first.astype(np.int64)
    return found


def n_step_fixed_point(experience: Experience, discount: float, tiles: int, steps: int) -> Array:
    """V at which the mean change of n-step TD is 0 in every tile, (tiles,) [rad²].

    The solution of the linear system V = R + γⁿ P V, where R of a tile is the mean of the n rewards that
    follow its visits, and P says in which tile the n-th state after them lies. With n = 1 it is that of
    TD(0): the value function of the chain of tiles.
    """
    led_to, rewards = np.zeros((tiles, tiles)), np.zeros(tiles)
    _sum_up(experience, discount, steps, led_to, rewards)
    visits = np.bincount(experience.tile, minlength=tiles)
    return np.linalg.solve(np.diag(np.maximum(visits, 1.0)) - led_to, rewards).astype(np.float64)


def lambda_fixed_point(experience: Experience, discount: float, tiles: int, trace: float) -> Array:
    """The same of TD(λ): the V for which the sum of δ e over all that was met is 0 (Boyan 2002)."""
    system, rewards, traces = np.zeros((tiles, tiles)), np.zeros(tiles), np.zeros(tiles)
    _sum_up_traces(experience, discount, trace, traces, system, rewards)
    unvisited = np.bincount(experience.tile, minlength=tiles) == 0
    return np.linalg.solve(system + np.diag(1.0 * unvisited), rewards).astype(np.float64)


@compiled
def _return_from_last(experience: Experience, discount: float, found: Array) -> None:
    following = 0.0
    for t in range(len(found) - 1, -1, -1):
        if experience.after[t] == ENDED:
            following = 0.0
        following = experience.reward[t] + discount * following
        found[t] = following


@compiled
def _sum_up(
    experience: Experience, discount: float, steps: int, led_to: Array, rewards: Array
) -> None:
    """Add γⁿ to a tile's row where the n-th state after a visit lies, and the rewards until there.

    A visit whose episode was cut short at the end of all that was met has as many steps as there are.
    """
    for t in range(len(experience.tile)):
        tile, weight, step = experience.tile[t], 1.0, t
        while True:
            rewards[tile] += weight * experience.reward[step]
            weight *= discount
            after = experience.after[step]
            step += 1
            if after == ENDED or step == t + steps or step == len(experience.tile):
                break
        if after != ENDED:
            led_to[tile, after] += weight


@compiled
def _sum_up_traces(
    experience: Experience,
    discount: float,
    trace: float,
    traces: Array,
    system: Array,
    rewards: Array,
) -> None:
    """Add e (x(s) − γ x(s′))ᵀ and e r for every step, where x is 1 in the state's own tile."""
    for t in range(len(experience.tile)):
        decay = 0.0 if t == experience.begun[t] else discount * trace
        for i in range(len(traces)):
            traces[i] *= decay
        tile, after = experience.tile[t], experience.after[t]
        traces[tile] += 1.0
        for i in range(len(traces)):
            if traces[i] == 0.0:
                continue
            rewards[i] += traces[i] * experience.reward[t]
            system[i, tile] += traces[i]
            if after != ENDED:
                system[i, after] -= discount * traces[i]
