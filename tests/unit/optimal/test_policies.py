"""Policies that are followed, searched for and projected onto tiles; and the tables of the bound."""

from functools import cache

import numpy as np
import pandas as pd
import pytest

from upswing.agents.features import locate
from upswing.optimal import bound as table
from upswing.optimal import rows, tile_rows
from upswing.optimal.follow import EPSILON, explored, follow
from upswing.optimal.policies import act
from upswing.optimal.solved import Solved, solve
from upswing.optimal.state_grid import Grid
from upswing.optimal.tile_policy import TilePolicy, score, thesis_tiles
from upswing.optimal.tile_search import projected, search
from upswing.optimal.value_iteration import promised
from upswing.physics import pendulum
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import HORIZONTAL
from upswing.runs.metrics import UPRIGHT
from upswing.runs.simulation import streams
from upswing.study.task import kind_of_task

BODY = Pendulum()


TINY, SMALL, MIDDLE, FINE = Grid(36, 21), Grid(72, 81), Grid(144, 161), Grid(288, 321)


@cache
def solved(grid: Grid) -> Solved:
    return solve(BODY, grid)


def turned(angle):
    """Within one turn, to the last bit: a whole turn less or more where it has to be."""
    if angle >= np.pi:
        return angle - 2 * np.pi
    return angle + 2 * np.pi if angle < -np.pi else angle


def test_following_against_a_plain_transcription():
    policy = solved(SMALL).optimal[0.97]
    angles = np.zeros(801)
    follow(policy, BODY, 0.2, np.random.default_rng(7), 2.0, -1.0, angles)
    draws, angle, velocity = np.random.default_rng(7), 2.0, -1.0
    for t in range(800):
        assert angles[t] == angle
        draw = draws.random()
        best = np.argmax([promised(policy, BODY, angle, velocity, action) for action in range(3)])
        action = int(draw / 0.2 * 3) if draw < 0.2 else int(best)
        angle, velocity = pendulum.step(BODY, angle, velocity, BODY.accelerations[action])
        angle = turned(angle)


def test_a_run_with_exploring_has_the_starts_and_the_draws_of_the_study():
    policy, steps = solved(SMALL).optimal[0.99], 5_000
    actions, starts, *_ = streams(3)
    angles = np.zeros(steps + 1)
    follow(policy, BODY, EPSILON, actions, np.pi * (2 * starts.random() - 1), 0.0, angles)
    run = explored(policy, BODY, seed=3, steps=steps)
    assert run.first_upright == np.flatnonzero(np.abs(angles) <= UPRIGHT)[0]
    assert run.mean_reward == pytest.approx(-np.mean(angles[-1_000:] ** 2))
    assert run.upright_share == np.mean(np.abs(angles[4_000:5_000]) <= UPRIGHT)
    assert run.above_horizontal_share == np.mean(np.abs(angles[4_000:5_000]) <= HORIZONTAL)


@pytest.mark.parametrize("kind", ["balancing", "full-control"])
def test_a_score_against_a_plain_transcription(kind):
    actions = np.random.default_rng(10).integers(0, 3, thesis_tiles(kind).tiles).astype(np.int8)
    visits = np.zeros(len(actions), dtype=np.int64)
    first, second = score(kind, BODY, actions, visits)
    seen, upright, rewards, lasted = np.zeros_like(visits), 0, 0.0, []
    for start in kind_of_task(kind).greedy_starts:
        angle, velocity = float(start), 0.0
        for t in range(4_000):
            tile = locate(thesis_tiles(kind), angle, velocity).tiles[0]
            seen[tile] += 1
            upright += t >= 3_000 and abs(angle) <= UPRIGHT
            angle, velocity = pendulum.step(
                BODY, angle, velocity, BODY.accelerations[actions[tile]]
            )
            angle = turned(angle)
            rewards -= angle**2 if t >= 3_000 else 0
            if kind == "balancing" and abs(angle) > HORIZONTAL:
                lasted.append(t + 1)
                break
    if kind == "balancing":
        assert len(lasted) == 9
        assert (first, second) == (np.mean(lasted) / 50_000, min(lasted) / 50_000)
    else:
        assert first == upright / 16_000
        assert second == pytest.approx(rewards / 16_000, rel=1e-6)
    np.testing.assert_array_equal(visits, seen)


@pytest.mark.parametrize(("kind", "seed"), [("balancing", 0), ("full-control", 1)])
def test_a_search_never_ends_worse_than_it_began_and_repeats_itself(kind, seed):
    begun = projected(kind, BODY, solved(SMALL).fastest)
    before = begun.copy()
    at_first = score(kind, BODY, begun, np.zeros(len(begun), dtype=np.int64))
    results = [search(kind, BODY, begun, seed, budget) for budget in (0, 30, 150, 150)]
    assert results[0].score == at_first
    assert at_first <= results[1].score <= results[2].score
    assert results[2].score > at_first  # there is much to gain from this beginning
    np.testing.assert_array_equal(results[2].actions, results[3].actions)
    np.testing.assert_array_equal(begun, before)
    again = score(kind, BODY, results[2].actions, np.zeros(len(begun), dtype=np.int64))
    assert again == results[2].score


def test_what_is_projected_is_what_most_of_a_tile_says():
    kind, rng = "full-control", np.random.default_rng(9)
    tiles = thesis_tiles(kind)
    on_tiles = rng.integers(0, 3, tiles.tiles).astype(np.int8)
    np.testing.assert_array_equal(projected(kind, BODY, TilePolicy(tiles, on_tiles)), on_tiles)


def test_both_tables_are_written(tmp_path, monkeypatch):
    monkeypatch.setattr(rows, "SEEDS", range(1))
    monkeypatch.setattr(tile_rows, "SEEDS", range(1000, 1001))
    monkeypatch.setattr(tile_rows, "BUDGET", 20)
    monkeypatch.setattr(tile_rows, "FURTHER", 20)
    monkeypatch.setattr(table, "GRIDS", (TINY, SMALL))
    table.write_bound(tmp_path)
    bound = pd.read_parquet(tmp_path / table.BOUND)
    assert {"quantity", "task", "policy", "discount", "grid", "value", "unit", "note"} == set(bound)
    assert set(bound.grid) == {"36×21", "72×81", "exact", "tiles"}
    key = ["quantity", "task", "policy", "discount", "grid"]
    assert not bound.duplicated(key).any()
    maps = pd.read_parquet(tmp_path / table.MAPS)
    assert len(maps) == 72 * 81
    assert maps.angle.nunique() <= 200
    upright = maps[(maps.angle == 0) & (maps.angular_velocity == 0)].iloc[0]
    assert upright.time_to_upright == 0
    assert upright.keepable
    state = maps[maps.time_to_upright > 0.3].iloc[0]
    policy = solve(BODY, SMALL, solve(BODY, TINY)).optimal[0.7]
    assert state["action_0.7"] == act(policy, BODY, state.angle, state.angular_velocity)
