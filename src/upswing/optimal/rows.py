"""What was solved → rows of a table, one a number."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from upswing.optimal.follow import Starts, explored, from_starts
from upswing.optimal.min_time import steps_taken
from upswing.optimal.solved import FAR_SIGHTED, THESIS, Solved, area, at_rest
from upswing.optimal.tables import FULL_CONTROL
from upswing.optimal.viability import balanced_angle, catchable_speed, catchable_speed_on
from upswing.physics.braking import highest_stoppable_speed
from upswing.physics.pendulum import Pendulum

EXACT = "exact"

SEEDS = range(10)
"""Runs with exploring have the starts and the draws of these runs of the study."""

PRECISION = 1e-3
"""The γ from which on it swings up is known to this."""


class Row(NamedTuple):
    """A number; its task, policy and γ where it has one."""

    quantity: str
    value: float
    unit: str  # empty: a share or a number
    grid: str  # ``360×401``, ``exact`` or ``tiles``
    task: str = FULL_CONTROL
    policy: str | None = None
    discount: float | None = None
    note: str = ""


def exact(body: Pendulum) -> Iterator[Row]:
    """What needs no grid."""
    yield Row("catchable_speed", catchable_speed(body), "rad/s", EXACT, note="by shooting")
    stoppable = highest_stoppable_speed(body)
    yield Row("stoppable_speed", stoppable, "rad/s", EXACT, note="comes to rest before +90°")
    angle = float(np.degrees(balanced_angle(body)))
    yield Row("balanced_angle", angle, "°", EXACT, note="at rest beyond it nothing helps")


def of_grid(solved: Solved) -> Iterator[Row]:
    """What can be kept, how long it takes to upright, and what each γ promises, on one grid."""
    body, grid, name = solved.body, solved.grid, solved.grid.name
    yield Row("catchable_speed", catchable_speed_on(grid, solved.above), "rad/s", name)
    for angle, kept in ((90, solved.above), (20, solved.upright)):
        note = f"states that can be kept within ±{angle}°"
        yield Row(f"keepable_area_{angle}", area(grid, kept), "rad²/s", name, note=note)
    seconds = at_rest(grid, solved.steps) * body.time_step
    from_hanging, mean = float(seconds[0]), float(seconds.mean())
    yield Row("time_from_hanging", from_hanging, "s", name, policy="fastest", note="promised")
    taken = steps_taken(solved.fastest, body, -np.pi, 0.0) * body.time_step
    yield Row("time_from_hanging_followed", taken, "s", name, policy="fastest")
    yield Row("mean_time_from_rest", mean, "s", name, policy="fastest", note="φ uniform")
    yield from of_starts(name, "fastest", None, from_starts(solved.fastest, body))
    for discount, policy in solved.optimal.items():
        value = float(at_rest(grid, policy.values)[0])
        yield Row("value_from_hanging", value, "rad²", name, FULL_CONTROL, "optimal", discount)
        yield from of_starts(name, "optimal", discount, from_starts(policy, body))


def of_starts(grid: str, policy: str, discount: float | None, starts: Starts) -> Iterator[Row]:
    """What came of the fixed starts, without exploring."""
    for quantity, value, unit in (
        ("success_share", starts.success_share, ""),
        ("success_from_hanging", float(starts.from_hanging), ""),
        ("upright_share", starts.upright_share, ""),
        ("mean_reward", starts.mean_reward, "rad²"),
    ):
        note = "16 starts at rest, without exploring"
        yield Row(quantity, value, unit, grid, FULL_CONTROL, policy, discount, note)


def thresholds(solved: Solved) -> Iterator[Row]:
    """The γ from which on the optimal policy swings up: from hanging, and from every start."""
    name = solved.grid.name
    for quantity, enough in (
        ("lowest_discount_from_hanging", lambda found: found.from_hanging),
        ("lowest_discount_from_all", lambda found: found.success_share == 1),
    ):
        value = _threshold(solved, enough)
        note = f"by halving between {THESIS} and {FAR_SIGHTED}, as if there were only one"
        yield Row(quantity, value, "", name, policy="optimal", note=note)


def _threshold(solved: Solved, enough: Callable[[Starts], bool]) -> float:
    low, high = THESIS, FAR_SIGHTED
    while high - low > PRECISION:
        middle = (low + high) / 2
        if enough(from_starts(solved.best(middle), solved.body)):
            high = middle
        else:
            low = middle
    return high


def with_exploring(
    body: Pendulum, policy: Any, grid: str, name: str, discount: float | None = None
) -> Iterator[Row]:
    """What came of a million steps with ε = 0.01, on average over the seeds."""
    runs = [explored(policy, body, seed) for seed in SEEDS]
    first = [run.first_upright for run in runs if run.first_upright is not None]
    never = float(np.mean([run.first_upright is None for run in runs]))
    for quantity, value, unit in (
        ("explored_upright_share", _mean(run.upright_share for run in runs), ""),
        ("explored_above_share", _mean(run.above_horizontal_share for run in runs), ""),
        ("explored_mean_reward", _mean(run.mean_reward for run in runs), "rad²"),
        ("explored_never_upright", never, ""),
        ("explored_first_upright", float(np.median(first)) if first else np.nan, "steps"),
    ):
        note = f"{len(SEEDS)} runs of 1,000,000 steps with ε = 0.01"
        yield Row(quantity, value, unit, grid, FULL_CONTROL, name, discount, note)


def _mean(values: Iterable[float]) -> float:
    return float(np.mean(list(values)))


def explored_optimal(solved: Solved) -> Iterator[Row]:
    """Runs with exploring of every policy of a grid."""
    yield from with_exploring(solved.body, solved.fastest, solved.grid.name, "fastest")
    for discount, policy in solved.optimal.items():
        yield from with_exploring(solved.body, policy, solved.grid.name, "optimal", discount)
