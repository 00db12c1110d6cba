"""Prediction: each method against its transcription, against its neighbours, and by hand."""

import os
import subprocess
import sys
from collections.abc import Sequence

import numpy as np
import pytest

from tests.oracles import prediction as textbook
from tests.paths import ROOT
from upswing.agents.features.grid import tiles_for
from upswing.agents.prediction import (
    AVERAGE,
    ENDED,
    Experience,
    StepSize,
    learn,
    monte_carlo,
    n_step,
    predict,
    td,
    td_lambda,
)
from upswing.agents.prediction.experience import met_at_random
from upswing.physics import pendulum, tasks
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL, reward
from upswing.study.readings import Readings

TILES = 6
DISCOUNT = 0.8
CONSTANT = StepSize(0.1)
DECAYING = StepSize(0.5, 20.0)
SIZES = pytest.mark.parametrize("step_size", [CONSTANT, DECAYING, AVERAGE])


def experience_of(episodes: textbook.Episodes) -> Experience:
    """Episodes one after the other, as methods are given them."""
    visits = [visit for episode in episodes for visit in episode]
    tile = np.array([one for one, _ in visits], np.int64)
    ends = np.cumsum([len(episode) for episode in episodes])
    after = np.append(tile[1:], ENDED)
    after[ends - 1] = ENDED
    begun = np.repeat(ends - [len(episode) for episode in episodes], [len(one) for one in episodes])
    nothing = np.zeros(len(tile))
    return Experience(nothing, nothing, tile, np.array([one for _, one in visits]), after, begun)


def some_episodes(number: int = 40, seed: int = 0, *, revisits: bool = True) -> textbook.Episodes:
    draws = np.random.default_rng(seed)
    return [
        [
            (int(tile), float(draws.normal()))
            for tile in (
                draws.integers(TILES, size=draws.integers(1, 9))
                if revisits
                else draws.permutation(TILES)[: draws.integers(1, TILES + 1)]
            )
        ]
        for _ in range(number)
    ]


def learned(method, episodes: textbook.Episodes) -> np.ndarray:
    predict(method, experience_of(episodes), DISCOUNT, np.zeros(0, np.int64), np.zeros((0, TILES)))
    return method.estimate.values


def sizes(step_size: StepSize) -> textbook.StepSize:
    return lambda updates: step_size.first / (1 + updates / step_size.halved_after)


def in_order(values: textbook.Values) -> Sequence[float]:
    return [values[tile] for tile in range(TILES)]


def test_first_and_every_visit_by_hand():
    # Returns with γ = 0.8: 1 + 0.8 · 2 + 0.64 · 4 = 5.16; 2 + 0.8 · 4 = 5.2; 4. Then 10.
    episodes = [[(0, 1.0), (1, 2.0), (0, 4.0)], [(0, 10.0)]]
    first = learned(monte_carlo.create(TILES, AVERAGE, first_visit=True), episodes)
    np.testing.assert_allclose(first[:3], [(5.16 + 10) / 2, 5.2, 0])
    every = learned(monte_carlo.create(TILES, AVERAGE, first_visit=False), episodes)
    np.testing.assert_allclose(every[:3], [(5.16 + 4 + 10) / 3, 5.2, 0])


@pytest.mark.parametrize("first_visit", [True, False])
def test_monte_carlo_averages_the_returns(first_visit):
    episodes = some_episodes()
    found = learned(monte_carlo.create(TILES, AVERAGE, first_visit=first_visit), episodes)
    expected = textbook.averages(episodes, DISCOUNT, first_visit=first_visit)
    np.testing.assert_allclose(found, in_order(expected))


def test_monte_carlo_learns_nothing_before_an_episode_is_over():
    method = monte_carlo.create(TILES, AVERAGE, first_visit=False)
    experience = experience_of([[(0, 1.0), (1, 1.0), (2, 1.0)]])
    for t in range(2):
        learn(method, experience, DISCOUNT, t)
    assert not method.estimate.values.any()
    learn(method, experience, DISCOUNT, 2)
    assert (method.estimate.values[:3] > 0).all()


@SIZES
@pytest.mark.parametrize("steps", [1, 2, 4, 100])
def test_n_step_td_is_its_transcription(steps, step_size):
    episodes = some_episodes()
    expected = textbook.n_step(episodes, DISCOUNT, steps, sizes(step_size))
    found = learned(n_step.create(TILES, step_size, steps), episodes)
    np.testing.assert_allclose(found, in_order(expected))


@SIZES
@pytest.mark.parametrize("trace", [0.0, 0.6, 1.0])
def test_td_lambda_is_its_transcription(trace, step_size):
    episodes = some_episodes()
    expected = textbook.traces(episodes, DISCOUNT, trace, sizes(step_size))
    found = learned(td_lambda.create(TILES, step_size, trace), episodes)
    np.testing.assert_allclose(found, in_order(expected))


@SIZES
@pytest.mark.parametrize("trace", [0.0, 0.6, 1.0])
def test_offline_the_backward_view_is_the_forward_view(trace, step_size):
    episodes = some_episodes()
    expected = textbook.lambda_returns(episodes, DISCOUNT, trace, sizes(step_size))
    found = learned(td_lambda.create(TILES, step_size, trace, offline=True), episodes)
    np.testing.assert_allclose(found, in_order(expected))


@SIZES
def test_one_step_and_lambda_0_are_td_0(step_size):
    episodes = some_episodes()
    expected = learned(td.create(TILES, step_size), episodes)
    np.testing.assert_array_equal(learned(n_step.create(TILES, step_size, 1), episodes), expected)
    found = learned(td_lambda.create(TILES, step_size, 0.0), episodes)
    np.testing.assert_allclose(found, expected, rtol=1e-12)


def test_offline_lambda_1_is_every_visit_monte_carlo():
    episodes = some_episodes()
    expected = learned(monte_carlo.create(TILES, AVERAGE, first_visit=False), episodes)
    found = learned(td_lambda.create(TILES, AVERAGE, 1.0, offline=True), episodes)
    np.testing.assert_allclose(found, expected)
    # With a constant α the order of the visits of one tile counts: equal where there is one an episode.
    episodes = some_episodes(revisits=False)
    expected = learned(monte_carlo.create(TILES, CONSTANT, first_visit=False), episodes)
    found = learned(td_lambda.create(TILES, CONSTANT, 1.0, offline=True), episodes)
    np.testing.assert_allclose(found, expected)


def test_as_many_steps_as_an_episode_has_are_every_visit_monte_carlo():
    episodes = some_episodes()
    expected = learned(monte_carlo.create(TILES, AVERAGE, first_visit=False), episodes)
    np.testing.assert_allclose(learned(n_step.create(TILES, AVERAGE, 9), episodes), expected)


def test_td_0_ends_at_the_solution_of_the_linear_system():
    """A chain that is Markov: V = R + γ P V, which numpy solves, from steps that were drawn from it."""
    draws = np.random.default_rng(1)
    leads = draws.dirichlet(np.ones(TILES + 1), size=TILES)  # the last column: the episode ends
    rewards = draws.normal(size=TILES)
    exact = np.linalg.solve(np.eye(TILES) - DISCOUNT * leads[:, :TILES], rewards)
    episodes, met = [], 0
    while met < 100_000:
        episode, tile = [], int(draws.integers(TILES))
        while tile < TILES:
            episode.append((tile, rewards[tile] + draws.normal()))
            tile = int(draws.choice(TILES + 1, p=leads[tile]))
        episodes.append(episode)
        met += len(episode)
    found = learned(td.create(TILES, StepSize(1.0, 10.0)), episodes)
    np.testing.assert_allclose(found, exact, atol=0.05)
    assert np.abs(exact).max() > 0.5


def test_values_are_kept_at_the_moments_asked_for():
    episodes = some_episodes(5)
    experience = experience_of(episodes)
    moments = np.array([1, 3, len(experience.tile)], np.int64)
    kept = np.full((3, TILES), np.nan)
    method = td.create(TILES, CONSTANT)
    predict(method, experience, DISCOUNT, moments, kept)
    np.testing.assert_array_equal(kept[2], method.estimate.values)
    again = td.create(TILES, CONSTANT)
    for t in range(3):
        learn(again, experience, DISCOUNT, t)
        if t == 0:
            np.testing.assert_array_equal(kept[0], again.estimate.values)
    np.testing.assert_array_equal(kept[1], again.estimate.values)


def test_what_is_no_method_is_refused():
    with pytest.raises(TypeError, match="is no method of prediction"):
        learn(object(), experience_of([[(0, 1.0)]]), DISCOUNT, 0)


def balanced(steps: int = 3_000, seed: int = 0, body: Pendulum | None = None) -> Experience:
    task = tasks.create("balancing", Readings())
    tiles = tiles_for(task, False, Readings())
    return met_at_random(body or Pendulum(), task, tiles, steps, seed)


def test_what_is_met_are_episodes_of_balancing_with_random_actions():
    body, met = Pendulum(), balanced()
    ended = met.after == ENDED
    assert 10 < ended.sum() < 100
    starts = np.append(0, np.flatnonzero(ended) + 1)
    np.testing.assert_array_equal(np.unique(met.begun), starts[starts < len(ended)])
    np.testing.assert_array_equal(met.after[~ended][:-1], met.tile[1:][~ended[:-1]])
    assert np.abs(met.angle[starts[:-1]]).max() <= np.radians(20)
    assert not met.angular_velocity[starts[:-1]].any()
    assert np.abs(met.angle).max() <= HORIZONTAL
    taken = np.zeros(3)
    for t in range(len(ended) - 1):
        after = [
            pendulum.step(body, met.angle[t], met.angular_velocity[t], acceleration)
            for acceleration in body.accelerations
        ]
        action = int(np.argmin([abs(reward(angle) - met.reward[t]) for angle, _ in after]))
        taken[action] += 1
        assert reward(after[action][0]) == pytest.approx(met.reward[t])
        assert (abs(after[action][0]) > HORIZONTAL) == ended[t]
        if not ended[t]:
            assert after[action] == pytest.approx((met.angle[t + 1], met.angular_velocity[t + 1]))
    np.testing.assert_allclose(taken / taken.sum(), 1 / 3, atol=0.04)


def test_the_same_seed_meets_the_same_and_another_pendulum_has_its_own_actions():
    one, again, other = balanced(), balanced(), balanced(seed=1)
    np.testing.assert_array_equal(one.reward, again.reward)
    assert (one.reward != other.reward).any()
    two_actions = balanced(body=Pendulum(accelerations=(-8.0, 8.0)))
    assert (two_actions.after == ENDED).any()


PLAIN = """
import sys
import numpy as np
from tests.unit.agents.test_prediction import predicted_from_balancing
np.save(sys.argv[1], predicted_from_balancing())
"""


def predicted_from_balancing() -> np.ndarray:
    """V of every method after 600 steps of balancing, (methods, tiles)."""
    met = balanced(600)
    methods = (
        td.create(80, CONSTANT),
        n_step.create(80, CONSTANT, 4),
        td_lambda.create(80, DECAYING, 0.9),
        td_lambda.create(80, CONSTANT, 0.9, offline=True),
        monte_carlo.create(80, AVERAGE, first_visit=True),
        monte_carlo.create(80, CONSTANT, first_visit=False),
    )
    for method in methods:
        predict(method, met, 0.97, np.zeros(0, np.int64), np.zeros((0, 80)))
    return np.stack([method.estimate.values for method in methods])


def test_compiled_and_plain_python_are_the_same_to_the_last_bit(tmp_path):
    plain = tmp_path / "plain.npy"
    subprocess.run(
        [sys.executable, "-c", PLAIN, str(plain)],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"}, cwd=ROOT, check=True,
    )  # fmt: skip
    compiled = predicted_from_balancing()
    assert compiled.any(axis=1).all()
    np.testing.assert_array_equal(np.load(plain), compiled)
