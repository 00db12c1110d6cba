"""Methods of prediction as plain transcriptions of the textbook, an episode at a time and without arrays."""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator, Sequence

Visit = tuple[int, float]
"""A tile and the reward that followed it."""

Episodes = Sequence[Sequence[Visit]]
StepSize = Callable[[int], float]
"""By the number of earlier updates of a tile."""

Values = defaultdict[int, float]


def returns(episode: Sequence[Visit], discount: float) -> list[float]:
    """The return of every visit: eq. 1, as it is written."""
    rewards = [reward for _, reward in episode]
    return [
        sum(discount**k * reward for k, reward in enumerate(rewards[t:]))
        for t in range(len(rewards))
    ]


def averages(episodes: Episodes, discount: float, *, first_visit: bool) -> Values:
    """Monte Carlo: a list of returns for each tile, and their mean."""
    found: defaultdict[int, list[float]] = defaultdict(list)
    for episode in episodes:
        tiles = [tile for tile, _ in episode]
        for t, return_ in enumerate(returns(episode, discount)):
            if not first_visit or tiles[t] not in tiles[:t]:
                found[tiles[t]].append(return_)
    return Values(float, {tile: sum(all_) / len(all_) for tile, all_ in found.items()})


def n_step(episodes: Episodes, discount: float, steps: int, step_size: StepSize) -> Values:
    """n-step TD after Sutton and Barto (2018), p. 144: τ is the time whose estimate is updated."""
    values, updates = Values(float), Counter[int]()
    for episode in episodes:
        end = len(episode)
        for t in range(end + steps - 1):
            tau = t - steps + 1
            if tau < 0 or tau >= end:
                continue
            last = min(tau + steps, end)
            target = sum(discount ** (i - tau) * episode[i][1] for i in range(tau, last))
            if tau + steps < end:
                target += discount**steps * values[episode[tau + steps][0]]
            tile = episode[tau][0]
            values[tile] += step_size(updates[tile]) * (target - values[tile])
            updates[tile] += 1
    return values


def traces(episodes: Episodes, discount: float, trace: float, step_size: StepSize) -> Values:
    """TD(λ) with accumulating traces: every tile is moved by the step size of its latest visit."""
    values, visits = Values(float), Counter[int]()
    for episode in episodes:
        e: Values = Values(float)
        for (tile, reward), after in zip(episode, _after(episode), strict=True):
            error = reward - values[tile] + (0 if after is None else discount * values[after])
            for other in e:
                e[other] *= discount * trace
            e[tile] += 1
            visits[tile] += 1
            for other, much in e.items():
                values[other] += step_size(visits[other] - 1) * error * much
    return values


def lambda_returns(
    episodes: Episodes, discount: float, trace: float, step_size: StepSize
) -> Values:
    """Offline TD(λ) from its forward view: each visit's λ-return against V before the episode."""
    values, visits = Values(float), Counter[int]()
    for episode in episodes:
        moved: Values = Values(float)
        for t, (tile, _) in enumerate(episode):
            visits[tile] += 1
            moved[tile] += _lambda_return(episode, t, values, discount, trace) - values[tile]
        for tile, much in moved.items():
            values[tile] += step_size(visits[tile] - 1) * much
    return values


def _lambda_return(
    episode: Sequence[Visit], t: int, values: Values, discount: float, trace: float
) -> float:
    """(1 − λ) Σ λⁿ⁻¹ G⁽ⁿ⁾, and what is left of the weights for the whole return."""
    left, total, so_far = len(episode) - t, 0.0, 0.0
    for n in range(1, left):
        so_far += discount ** (n - 1) * episode[t + n - 1][1]
        n_step_return = so_far + discount**n * values[episode[t + n][0]]
        total += (1 - trace) * trace ** (n - 1) * n_step_return
    so_far += discount ** (left - 1) * episode[-1][1]
    return total + trace ** (left - 1) * so_far


def _after(episode: Sequence[Visit]) -> Iterator[int | None]:
    yield from (tile for tile, _ in episode[1:])
    yield None
