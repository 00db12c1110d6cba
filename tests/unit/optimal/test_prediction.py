"""Prediction against the truth: V of random actions on a grid, on tiles, and where methods end."""

import numpy as np
import pandas as pd
import pytest
from scipy.sparse import coo_array, eye_array
from scipy.sparse.linalg import spsolve

from upswing.agents.features.grid import tiles_for
from upswing.agents.prediction import ENDED, Experience, StepSize, n_step, predict, td, td_lambda
from upswing.agents.prediction.experience import met_at_random
from upswing.optimal import prediction, tile_values
from upswing.optimal.prediction import METHODS, STEP_SIZES, THESIS, best, write_prediction
from upswing.optimal.prediction_tables import (
    HALF_AS_FINE,
    OF_LIMITS,
    OF_PREDICTION,
    REMEDY,
    SIZE,
    SPREAD,
)
from upswing.optimal.random_actions import at_states, values_at_random
from upswing.optimal.state_grid import Grid, points, successors
from upswing.physics import tasks
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL
from upswing.runs.files.typed_table import read_table
from upswing.study.paths import PREDICTION, PREDICTION_LIMITS
from upswing.study.readings import Readings

BODY = Pendulum()
BALANCING = tasks.create("balancing", Readings())
TILES = tiles_for(BALANCING, False, Readings())
FIVE = Pendulum(length=0.4, accelerations=(-20.0, -10.0, 0.0, 10.0, 20.0))


@pytest.fixture(scope="module")
def met() -> Experience:
    """Whole episodes."""
    met = met_at_random(BODY, BALANCING, TILES, 200_000, 5)
    return Experience(*(column[: met.begun[-1]] for column in met))


@pytest.mark.parametrize("body", [BODY, FIVE], ids=["thesis", "five actions"])
@pytest.mark.parametrize("discount", [0.7, 0.97])
def test_v_of_random_actions_solves_the_linear_system(body, discount):
    grid = Grid(24, 21)
    ways, angles = successors(body, grid), points(grid)[0]
    size, actions = ways.corner.shape
    above = (ways.corner + grid.columns) % size
    up, across = ways.up, ways.across
    goes_on = np.abs(ways.angle) <= HORIZONTAL
    rows = np.repeat(np.arange(size), actions)
    system = eye_array(size).tocsc()
    for corner, weight in (
        (ways.corner, (1 - up) * (1 - across)),
        (ways.corner + 1, (1 - up) * across),
        (above, up * (1 - across)),
        (above + 1, up * across),
    ):
        weights = (goes_on * weight).ravel() * discount / actions
        system = system - coo_array((weights, (rows, corner.ravel())), shape=(size, size)).tocsc()
    exact = spsolve(system, -(ways.angle**2).mean(axis=1))
    upright = np.abs(angles) < HORIZONTAL + 1e-9
    found = values_at_random(body, grid, discount)
    np.testing.assert_allclose(found[upright], exact[upright], atol=2e-5)
    assert not found[~upright].any()


def test_a_grid_without_points_at_the_horizontal_is_refused():
    with pytest.raises(ValueError, match="90 rows has no points at the horizontal"):
        values_at_random(BODY, Grid(90, 101), 0.7)


def test_the_grid_s_values_are_the_mean_returns(met):
    discount, grid = 0.97, Grid(360, 401)
    exact = at_states(grid, values_at_random(BODY, grid, discount), met.angle, met.angular_velocity)
    return_ = tile_values.returns(met, discount)
    truth = tile_values.tile_values(met, exact, TILES.tiles)
    wrong = tile_values.error(tile_values.means(met.tile, return_, TILES.tiles), truth)
    assert wrong < 0.15  # by sampling and by the grid; V is of the size of 13
    assert truth.share.sum() == pytest.approx(1)
    # What a tile hides is part of V, but not all of it.
    assert 0.1 < truth.spread / np.sqrt(np.mean(exact**2)) < 0.5


def by_hand() -> Experience:
    """Two episodes on three tiles: 0 1 0, then 1 2."""
    tile = np.array([0, 1, 0, 1, 2])
    return Experience(
        np.zeros(5), np.zeros(5), tile, np.array([1.0, 2.0, 4.0, 3.0, 5.0]),
        np.array([1, 0, ENDED, 2, ENDED]), np.array([0, 0, 0, 3, 3]),
    )  # fmt: skip


def test_returns_and_first_visits_by_hand():
    np.testing.assert_allclose(tile_values.returns(by_hand(), 0.5), [3, 4, 4, 5.5, 5])
    np.testing.assert_array_equal(tile_values.first_visits(by_hand(), 3), [0, 1, 3, 4])


def test_the_fixed_point_of_td_0_is_the_value_of_the_chain_of_tiles():
    # From 0: half of the visits lead to 1, half end; from 1: half to 0, half to 2; from 2 all end.
    leads = np.array([[0, 0.5, 0], [0.5, 0, 0.5], [0, 0, 0]])
    rewards = np.array([2.5, 2.5, 5])
    exact = np.linalg.solve(np.eye(3) - 0.5 * leads, rewards)
    np.testing.assert_allclose(tile_values.n_step_fixed_point(by_hand(), 0.5, 3, 1), exact)
    np.testing.assert_allclose(tile_values.lambda_fixed_point(by_hand(), 0.5, 3, 0.0), exact)
    # A tile that was never visited has the value 0, and changes nothing.
    further = tile_values.n_step_fixed_point(by_hand(), 0.5, 4, 1)
    np.testing.assert_allclose(further, [*exact, 0])
    further = tile_values.lambda_fixed_point(by_hand(), 0.5, 4, 0.0)
    np.testing.assert_allclose(further, [*exact, 0])


def test_without_bootstrapping_the_fixed_points_are_the_mean_returns(met):
    mean = tile_values.means(met.tile, tile_values.returns(met, 0.97), TILES.tiles)
    found = tile_values.lambda_fixed_point(met, 0.97, TILES.tiles, 1.0)
    np.testing.assert_allclose(found, mean, atol=1e-8)
    found = tile_values.n_step_fixed_point(met, 0.97, TILES.tiles, 1_000)
    np.testing.assert_allclose(found, mean, atol=1e-8)


@pytest.mark.parametrize("steps", [1, 4])
def test_no_tile_is_moved_at_the_fixed_point_on_average(met, steps):
    exact = tile_values.n_step_fixed_point(met, 0.97, TILES.tiles, steps)
    method = n_step.create(TILES.tiles, StepSize(1e-8), steps)
    method.estimate.values[:] = exact
    predict(method, met, 0.97, np.zeros(0, np.int64), np.zeros((0, TILES.tiles)))
    moved = (method.estimate.values - exact) / 1e-8 / np.maximum(method.estimate.updates, 1)
    assert np.abs(moved).max() < 1e-4
    assert np.count_nonzero(method.estimate.updates) > 20


@pytest.mark.parametrize(
    ("create", "limit"),
    [
        (td.create, lambda met, tiles: tile_values.n_step_fixed_point(met, 0.7, tiles, 1)),
        (
            lambda tiles, size: td_lambda.create(tiles, size, 0.5),
            lambda met, tiles: tile_values.lambda_fixed_point(met, 0.7, tiles, 0.5),
        ),
    ],
    ids=["TD(0)", "TD(0.5)"],
)
def test_td_on_tiles_goes_to_its_fixed_point_and_not_to_the_mean(met, create, limit):
    tiles = TILES.tiles
    method = create(tiles, StepSize(1.0, 5.0))
    predict(method, met, 0.7, np.zeros(0, np.int64), np.zeros((0, tiles)))
    return_ = tile_values.returns(met, 0.7)
    mean = tile_values.tile_values(met, return_, tiles)
    ends = mean._replace(mean=limit(met, tiles))
    values = method.estimate.values
    assert tile_values.error(values, ends) < 0.5 * tile_values.error(values, mean)


def test_the_rule_takes_the_least_mean_error_and_nothing_that_overflowed():
    one, two, three, four = STEP_SIZES[:4]
    tried = {
        ("a", one): np.array([[3.0, 1.0]]),
        ("a", two): np.array([[1.0, 2.0]]),
        ("a", three): np.array([[0.1, np.nan]]),
        ("b", four): np.array([[0.0, 0.0]]),
    }
    assert best(tried, "a") == two


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Both tables, of short runs on a coarse grid with γ = 0.7."""
    folder = tmp_path_factory.mktemp("prediction")
    (folder / "tables").mkdir()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(prediction, "PROBLEMS", ((0.7, THESIS),))
        patch.setattr(prediction, "GRID", Grid(240, 201))
        patch.setattr(prediction, "MET", 100_000)
        patch.setattr(prediction, "STEPS", 2_000)
        patch.setattr(prediction, "MOMENTS", np.array([100, 2_000]))
        patch.setattr(prediction, "CHOOSING", range(3))
        patch.setattr(prediction, "SHOWN", range(3, 8))
        write_prediction(folder)
    return folder


def test_each_method_is_shown_with_the_step_size_that_was_best(written):
    table = read_table(written / PREDICTION, OF_PREDICTION, REMEDY)
    assert list(dict.fromkeys(table["method"])) == list(METHODS)
    for _, own in table.groupby("method"):
        tried, shown = (own[own["seeds"] == seeds] for seeds in ("choosing", "shown"))
        assert len(tried) == 2 * len(STEP_SIZES)
        assert set(tried["runs"]) == {3}
        assert set(shown["runs"]) == {5}
        assert list(shown["steps"]) == [100, 2_000]
        mean = tried.groupby(["step_size", "halved_after"], dropna=False)["error"].mean()
        first, halved_after = mean.idxmin()
        assert set(shown["step_size"]) == {first}
        assert (shown["halved_after"].isna() == pd.isna(halved_after)).all()
        assert (shown["low"] <= shown["high"]).all()
        assert shown["error"].iloc[1] < shown["error"].iloc[0]
    assert table["halved_after"].isna().any()  # where it is constant


def test_the_limits_say_what_bootstrapping_ends_at(written):
    table = read_table(written / PREDICTION_LIMITS, OF_LIMITS, REMEDY)
    limit = dict(zip(table["quantity"], table["value"], strict=True))
    assert limit.keys() >= set(METHODS)
    assert limit["TD(0)"] > limit["4-step TD"] > limit["16-step TD"]
    assert limit["TD(0)"] > limit["TD(0.9)"] > limit["every-visit Monte Carlo"]
    assert limit[HALF_AS_FINE] < 0.1 * limit[SPREAD] < 0.1 * limit[SIZE]


def test_the_seeds_of_the_choice_are_not_those_that_are_shown():
    seeds = (set(prediction.CHOOSING), set(prediction.SHOWN), {prediction.REFERENCE})
    assert len(set.union(*seeds)) == sum(map(len, seeds))
