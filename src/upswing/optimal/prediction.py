"""Methods of prediction side by side (§2.4.3, §2.4.4) → ``tables/prediction.parquet``.

The seeds, the step sizes and the rule that chooses one of them for each method were written down before
any of the runs that are shown. The rule looks at seeds of its own.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from upswing.agents.features.grid import Tiles, tiles_for
from upswing.agents.prediction import (
    Array,
    Experience,
    StepSize,
    monte_carlo,
    n_step,
    predict,
    td,
    td_lambda,
)
from upswing.agents.prediction.experience import met_at_random
from upswing.optimal import tile_values
from upswing.optimal.prediction_tables import BAND, HALF_AS_FINE, SIZE, SPREAD, VARYING
from upswing.optimal.random_actions import at_states, values_at_random
from upswing.optimal.state_grid import VELOCITY_LIMIT, Grid
from upswing.optimal.tile_values import TileValues
from upswing.physics import tasks
from upswing.physics.pendulum import Pendulum
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.study.paths import PREDICTION, PREDICTION_LIMITS
from upswing.study.physical import TileOptions
from upswing.study.readings import Readings

THESIS = TileOptions()
FINER = TileOptions(angle_parts=16, velocity_parts=80)
"""Tiles a quarter as wide and high: they hide less of the state."""

PROBLEMS = ((0.7, THESIS), (0.97, THESIS), (0.97, FINER))
"""γ and tiles: the thesis's own (§4.5.1); a longer view; and that on finer tiles."""

METHODS: dict[str, Callable[[int, StepSize], Any]] = {
    "TD(0)": td.create,
    "4-step TD": lambda tiles, step_size: n_step.create(tiles, step_size, 4),
    "16-step TD": lambda tiles, step_size: n_step.create(tiles, step_size, 16),
    "TD(0.9)": lambda tiles, step_size: td_lambda.create(tiles, step_size, 0.9),
    "first-visit Monte Carlo": lambda tiles, step_size: monte_carlo.create(
        tiles, step_size, first_visit=True
    ),
    "every-visit Monte Carlo": lambda tiles, step_size: monte_carlo.create(
        tiles, step_size, first_visit=False
    ),
}  # fmt: skip
"""From the most bootstrapping to none."""

STEP_SIZES = (
    *(StepSize(2.0**-power) for power in range(1, 10)),
    *(StepSize(1.0, halved_after) for halved_after in (1, 3, 10, 30, 100, 300, 1000)),
)
"""A constant α from 1/2 to 1/512; and such as decay from 1, the first of which averages all targets."""

STEPS = 100_000
MOMENTS = np.unique(np.geomspace(100, STEPS, 31).round().astype(np.int64))
"""The numbers of steps after which an error is measured: evenly spaced on a log scale."""

CHOOSING, SHOWN = range(40_000, 40_020), range(43_000, 43_100)
"""The seeds that step sizes are chosen on, and those of the runs that are shown."""

REFERENCE, MET = 42_000, 3_000_000
"""Seed and number of steps of what says how often a tile is visited, and in which states."""

GRID = Grid(720, 801)
"""The grid on which V is exact; the one half as fine says how exact."""


class Row(NamedTuple):
    """How wrong a method is after so many steps, over several seeds."""

    discount: float  # γ
    tiles: int  # how many there are
    method: str  # of ``METHODS``
    step_size: float  # α of the first update of a tile
    halved_after: float  # how many updates halve it; none where it is constant
    seeds: str  # ``choosing``, or ``shown``: those of the step size that was chosen
    runs: int  # how many seeds
    steps: int  # the pendulum's steps so far
    error: float  # root mean square over steps [rad²], mean over seeds; none where a run overflowed
    low: float  # the quantiles over seeds of ``BAND``
    high: float


class Limit(NamedTuple):
    """What no number of steps gets below, and how exact the truth is."""

    discount: float
    tiles: int
    quantity: str
    value: float  # root mean square over steps [rad²]


class Problem(NamedTuple):
    """What is to be predicted."""

    body: Pendulum
    discount: float  # γ
    tiles: Tiles
    truth: TileValues


BALANCING = tasks.create("balancing", Readings())


def write_prediction(results: Path, body: Pendulum | None = None) -> None:
    """Let all methods predict, and write both tables."""
    rows: list[Row] = []
    limits: list[Limit] = []
    for discount, options in PROBLEMS:
        problem, found = posed(body or Pendulum(), discount, options)
        limits += found
        rows += compared(problem)
    table = pd.DataFrame(rows).replace({"halved_after": {np.inf: np.nan}})
    write_table(results / PREDICTION, table)
    write_table(results / PREDICTION_LIMITS, pd.DataFrame(limits))
    seal(results, "prediction", [results / PREDICTION, results / PREDICTION_LIMITS])


def posed(body: Pendulum, discount: float, options: TileOptions) -> tuple[Problem, list[Limit]]:
    """A problem with its truth, and what limits the methods."""
    tiles = tiles_for(BALANCING, False, Readings(), options)
    met = met_at_random(body, BALANCING, tiles, MET, REFERENCE)
    reach = max(VELOCITY_LIMIT, 1.2 * float(np.abs(met.angular_velocity).max()))
    exact, rough = (
        at_states(grid, values_at_random(body, grid, discount), met.angle, met.angular_velocity)
        for grid in (GRID._replace(limit=reach), _half(GRID._replace(limit=reach)))
    )
    truth = tile_values.tile_values(met, exact, tiles.tiles)
    limits = [
        Limit(discount, tiles.tiles, quantity, value)
        for quantity, value in _limits(met, exact, rough, truth, discount)
    ]
    return Problem(body, discount, tiles, truth), limits


def _limits(
    met: Experience, exact: Array, rough: Array, truth: TileValues, discount: float
) -> Iterator[tuple[str, float]]:
    """Each quantity [rad²]; that of a method is where its error goes with ever more steps."""
    tiles, return_ = len(truth.mean), tile_values.returns(met, discount)
    yield SIZE, _root_mean_square(exact)
    yield SPREAD, truth.spread
    yield VARYING, _root_mean_square(return_ - exact)
    yield HALF_AS_FINE, _error(tile_values.means(met.tile, rough, tiles), truth)
    for method, steps in (("TD(0)", 1), ("4-step TD", 4), ("16-step TD", 16)):
        yield method, _error(tile_values.n_step_fixed_point(met, discount, tiles, steps), truth)
    yield "TD(0.9)", _error(tile_values.lambda_fixed_point(met, discount, tiles, 0.9), truth)
    first = tile_values.first_visits(met, tiles)
    for method, visits in (
        ("first-visit Monte Carlo", first),
        ("every-visit Monte Carlo", slice(None)),
    ):
        yield method, _error(tile_values.means(met.tile[visits], return_[visits], tiles), truth)


def _root_mean_square(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _error(values: Array, truth: TileValues) -> float:
    return float(tile_values.error(values, truth))


def _half(grid: Grid) -> Grid:
    """The grid with every other point."""
    return grid._replace(rows=grid.rows // 2, columns=(grid.columns + 1) // 2)


Candidate = tuple[str, StepSize]
"""A method and its step size."""


def compared(problem: Problem) -> list[Row]:
    """All methods with all step sizes on the seeds for choosing, and with the best on the others."""
    tried = errors_of(problem, list(product(METHODS, STEP_SIZES)), CHOOSING)
    chosen = [(method, best(tried, method)) for method in METHODS]
    shown = errors_of(problem, chosen, SHOWN)
    return [
        row
        for seeds, errors in (("choosing", tried), ("shown", shown))
        for candidate, found in errors.items()
        for row in _rows(problem, candidate, seeds, found)
    ]


def best(tried: Mapping[Candidate, Array], method: str) -> StepSize:
    """The rule: the step size with the least error, averaged over all moments and seeds.

    One with which any run overflowed is not taken.

    Args:
        tried: the errors of each candidate on the seeds for choosing.
        method: whose step size is asked.
    """
    mean = {size: float(errors.mean()) for (name, size), errors in tried.items() if name == method}
    return min(mean, key=lambda size: mean[size] if np.isfinite(mean[size]) else np.inf)


def errors_of(
    problem: Problem, candidates: Sequence[Candidate], seeds: Sequence[int]
) -> dict[Candidate, Array]:
    """The errors of each candidate, (seeds, moments) [rad²], NaN from where a value overflowed.

    With one seed all learn from the same experience.
    """
    tiles = problem.tiles.tiles
    kept = np.zeros((len(MOMENTS), tiles))
    errors = {candidate: np.zeros((len(seeds), len(MOMENTS))) for candidate in candidates}
    for number, seed in enumerate(seeds):
        met = met_at_random(problem.body, BALANCING, problem.tiles, STEPS, seed)
        for method, step_size in candidates:
            predict(METHODS[method](tiles, step_size), met, problem.discount, MOMENTS, kept)
            with np.errstate(over="ignore", invalid="ignore"):
                wrong = tile_values.error(kept, problem.truth)
            errors[method, step_size][number] = np.where(np.isfinite(wrong), wrong, np.nan)
    return errors


def _rows(problem: Problem, candidate: Candidate, seeds: str, errors: Array) -> list[Row]:
    low, high = np.quantile(errors, BAND, axis=0)
    method, (first, halved_after) = candidate
    of = (problem.discount, problem.tiles.tiles, method, first, halved_after, seeds, len(errors))
    columns = zip(MOMENTS.tolist(), errors.mean(axis=0), low, high, strict=True)
    return [
        Row(*of, steps, float(mean), float(least), float(most))
        for steps, mean, least, most in columns
    ]
