"""The Gymnasium environments: the study's pendulum step for step, and what Gymnasium asks of one."""

import subprocess
import sys
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from tests.helpers import make_spec, run
from upswing.physics import gym as environments
from upswing.physics import tasks
from upswing.runs.simulation import streams
from upswing.study.readings import Readings

KINDS = {kind: name for name, kind in environments.ENVIRONMENTS.items()}


def make(kind, **options):
    return gymnasium.make(KINDS[kind], **options)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("architecture", ["random", "table"])
def test_its_steps_are_those_of_the_loop_bit_for_bit(kind, architecture):
    trajectory, _ = run(make_spec(kind, architecture, 0.5, steps=3_000), seed=1000)
    env = make(kind).unwrapped
    _, env.np_random, *_ = streams(
        1000
    )  # so its starts are those of the run, the first and the later
    _, info = env.reset()
    for t in range(3_000):
        for name, value in info.items():
            assert np.float32(value) == getattr(trajectory, name)[t], (name, t)
        _, reward, terminated, truncated, info = env.step(np.int64(trajectory.action[t]))
        assert np.float32(reward) == trajectory.reward[t]
        assert terminated == trajectory.reset[t]
        assert not truncated
        if terminated:
            _, info = env.reset()
    # What was compared had falls, and turned over at the bottom.
    assert trajectory.reset.sum() > 3 or kind == "full-control"
    assert (np.abs(np.diff(trajectory.angle)) > 6).any() or kind == "balancing"


@pytest.mark.parametrize("kind", KINDS)
def test_gymnasium_has_nothing_to_say_against_it(kind):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(make(kind).unwrapped)


@pytest.mark.parametrize("kind", KINDS)
def test_a_seed_gives_the_start_that_the_study_draws_from_it(kind):
    env, task = make(kind), tasks.create(kind, Readings())
    for seed in range(5):
        draws = np.random.default_rng(seed)
        for first in (True, False):  # the next start goes on with the same stream
            _, info = env.reset(seed=seed if first else None)
            assert (info["angle"], info["angular_velocity"]) == tasks.start(task, draws)
            assert info["cart_position"] == info["cart_velocity"] == 0


@pytest.mark.parametrize("kind", KINDS)
def test_the_state_can_be_had_from_the_observation(kind):
    env = make(kind)
    env.action_space.seed(0)
    observation, info = env.reset(seed=0)
    for _ in range(400):
        cosine, sine, velocity = observation
        assert np.arctan2(sine, cosine) == pytest.approx(info["angle"], abs=1e-14)
        assert velocity == info["angular_velocity"]
        observation, _, terminated, _, info = env.step(env.action_space.sample())
        if terminated:
            observation, info = env.reset()


def test_a_start_can_be_given_and_must_be_one():
    env = make("balancing")
    observation, info = env.reset(options={"angle": 0.5, "angular_velocity": -2.0})
    assert (info["angle"], info["angular_velocity"]) == (0.5, -2.0)
    assert observation == pytest.approx([np.cos(0.5), np.sin(0.5), -2.0])
    for wrong in ({"angle": 2.0}, {"angle": np.nan}, {"angular_velocity": 200.0}, {"speed": 1}):
        with pytest.raises(ValueError, match="options"):
            env.reset(options=wrong)
    with pytest.raises(ValueError, match="must be 0, 1 or 2"):
        env.unwrapped.step(3)


@pytest.mark.parametrize(("kind", "limit"), [("balancing", 2_000), ("full-control", 4_000)])
def test_an_episode_is_cut_after_its_time_not_ended(kind, limit):
    env = make(kind)
    _, info = env.reset(options={"angle": 0.1})
    for t in range(1, limit + 1):
        leaning = info["angle"] + 0.1 * info["angular_velocity"]  # enough to balance by hand
        _, _, terminated, truncated, info = env.step(0 if leaning > 0 else 2)
        assert not terminated
        assert truncated == (t == limit)


@pytest.mark.parametrize("action", range(3))
def test_no_velocity_leaves_the_observation_space(action):
    env = make("full-control").unwrapped
    largest = env.observation_space.high[2]
    for angle in np.linspace(-np.pi, np.pi, 101):
        for velocity in (-largest, 0.99 * largest, largest):
            env.reset(options={"angle": angle, "angular_velocity": velocity})
            observation, *_ = env.step(action)
            assert env.observation_space.contains(observation), (angle, velocity)


def test_pictures_show_where_the_pendulum_is():
    env = make("full-control", render_mode="rgb_array")

    def red_at(angle):
        env.reset(options={"angle": angle})
        picture = env.render().astype(int)
        rows, columns = np.nonzero(picture[..., 0] - picture[..., 1] > 100)
        return rows.mean(), columns.mean()

    assert red_at(0.0)[0] < red_at(-np.pi)[0] - 40  # rows count downwards
    left, right = red_at(1.0)[1], red_at(-1.0)[1]
    assert left < right - 40  # a positive φ leans to the left: ẍ > 0 drives φ up (eq. 16)
    env = make("balancing", render_mode="ansi")
    env.reset(options={"angle": 0.25})
    assert "φ +0.250 rad" in env.render()
    with pytest.raises(ValueError, match="render_mode"):
        environments.PendulumEnvironment("balancing", "video")


def python(script):
    return subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)


def test_gymnasium_finds_it_by_module_and_name():
    script = (
        "import gymnasium as g; print(g.make('upswing.physics.gym:upswing/FullControl-v0').spec.id)"
    )
    assert python(script).stdout == "upswing/FullControl-v0\n"


def test_without_gymnasium_upswing_works_and_the_environments_name_the_extra():
    hidden = "import sys; sys.modules['gymnasium'] = None; import upswing.cli.main, upswing.runs.train, upswing.physics"
    assert python(hidden).returncode == 0
    failed = python(f"{hidden}.gym")
    assert failed.returncode == 1
    assert failed.stderr.count("Traceback") == 1
    assert failed.stderr.splitlines()[-1] == (
        "ImportError: upswing.physics.gym needs Gymnasium, the extra `gymnasium`: "
        "pip install -e '.[gymnasium]'"
    )
