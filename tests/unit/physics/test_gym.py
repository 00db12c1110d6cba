"""The Gymnasium environments: the study's pendulum step for step, and what Gymnasium asks of one."""

import subprocess
import sys
import warnings
from time import monotonic

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from PIL import Image

from tests.helpers import make_spec, run
from upswing.physics import gym as environments
from upswing.physics import tasks, window
from upswing.physics.environment import State
from upswing.physics.pendulum import Pendulum
from upswing.physics.picture import picture
from upswing.physics.window import NoWindow
from upswing.runs.simulation import streams
from upswing.study.readings import Readings

KINDS = {kind: name for name, kind in environments.ENVIRONMENTS.items()}


def make(kind, **options):
    return gymnasium.make(KINDS[kind], **options)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("architecture", ["random", "table"])
@pytest.mark.parametrize(
    "readings",
    [
        {},
        {"reset": "terminal"},
        {"reset": "reset"},
        {"reward_state": "current", "start_velocity": "random"},
        {"zero_of_angle": "hanging", "wrap": "unbounded"},
    ],
    ids=str,
)
def test_its_steps_are_those_of_the_loop_bit_for_bit(kind, architecture, readings):
    steps = 3_000 if not readings else 1_000
    spec = make_spec(kind, architecture, 0.5, steps=steps, **readings)
    trajectory, _ = run(spec, seed=1000)
    env = make(kind, readings=readings).unwrapped
    # so its starts are those of the run, the first and the later
    _, env.np_random, *_ = streams(1000)
    _, info = env.reset()
    how = readings.get("reset", "fallen")
    for t in range(steps):
        for name, value in info.items():
            assert np.float32(value) == getattr(trajectory, name)[t], (name, t)
        observation, reward, terminated, truncated, info = env.step(np.int64(trajectory.action[t]))
        assert np.float32(reward) == trajectory.reward[t]
        fell = bool(trajectory.reset[t])
        # R7: where the study bootstraps from the fallen state, the episode is cut and not ended.
        assert terminated == (fell and how == "terminal")
        assert truncated == (fell and how == "fallen")
        if terminated or truncated:
            assert observation[0] < 0  # what is seen last is the fallen state, below the horizontal
            _, info = env.reset()
    # What was compared had falls, and turned over at the bottom.
    assert trajectory.reset.sum() > 3 or kind == "full-control" or "wrap" in readings
    assert (np.abs(np.diff(trajectory.angle)) > 6).any() or kind == "balancing" or readings


@pytest.mark.parametrize("kind", KINDS)
def test_gymnasium_has_nothing_to_say_against_it(kind, monkeypatch):
    monkeypatch.setattr(window, "_with_windows", lambda: ["agg"])  # it opens a window too
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(make(kind).unwrapped)
        for how in ("terminal", "reset"):
            check_env(make(kind, readings={"reset": how}, render_mode="rgb_array").unwrapped)


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
        observation, _, _, truncated, info = env.step(env.action_space.sample())
        if truncated:
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
    with pytest.raises(
        ValueError, match="readings: reset: \"never\": must be 'fallen', 'terminal'"
    ):
        make("balancing", readings={"reset": "never"})


def test_a_large_picture_is_the_small_one_in_large():
    body, state = Pendulum(), State(0.7, 0.0, 0.034, 0.0)
    small, large = (picture(body, state, width).astype(int) for width in (240, 720))
    assert small.shape == (160, 240, 3)
    assert large.shape == (480, 720, 3)
    again = np.asarray(Image.fromarray(large.astype(np.uint8)).resize((240, 160), Image.BOX))
    assert np.abs(again.astype(int) - small).mean() < 3


def test_the_ground_passes_to_the_left_where_the_cart_goes_to_the_right():
    def marks(cart_position):
        row = picture(Pendulum(), State(0.0, 0.0, cart_position, 0.0))[98]
        dark = np.flatnonzero((row < 200).all(axis=1))
        return dark[np.abs(dark - 120) > 16]  # without the cart itself

    here, there = marks(0.02), marks(0.03)
    shift = 0.01 * 240 / 0.9
    assert len(here) == len(there) == 8
    assert np.abs(here - there - shift).max() <= 1
    assert np.abs(np.delete(np.diff(here), 3) - 0.1 * 240 / 0.9).max() <= 1


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_several_at_once_are_the_same_as_one_after_the_other(mode):
    name = KINDS["balancing"]
    many = gymnasium.make_vec(name, num_envs=2, vectorization_mode=mode)
    ones = [make("balancing"), make("balancing")]
    try:
        observations, _ = many.reset(seed=5)
        single = [env.reset(seed=5 + number)[0] for number, env in enumerate(ones)]
        assert (observations == single).all()
        for t in range(150):
            actions = np.array([(t // 5) % 3, 2 * (t % 2)])
            seen, rewards, _, cut, _ = many.step(actions)
            told = [env.step(int(a)) for env, a in zip(ones, actions, strict=True)]
            assert (seen == [one[0] for one in told]).all()
            assert (rewards == [one[1] for one in told]).all()
            assert (cut == [one[3] for one in told]).all()
            if cut.any():
                return
        pytest.fail("nothing fell, and so nothing was seen of a fall")
    finally:
        many.close()


def test_a_video_can_be_taken(tmp_path):
    pytest.importorskip("moviepy", reason="moviepy, of the extra `video`, is not installed")
    env = gymnasium.wrappers.RecordVideo(make("full-control", render_mode="rgb_array"), tmp_path)
    env.reset(seed=0)
    for _ in range(20):
        env.step(2)
    env.close()
    (film,) = tmp_path.glob("*.mp4")
    assert film.stat().st_size > 1_000


def test_a_window_shows_it_in_real_time(monkeypatch):
    plt = pytest.importorskip("matplotlib.pyplot")
    plt.switch_backend("agg")
    with pytest.raises(NoWindow, match=r'needs a display .* here it draws with agg.* "rgb_array"'):
        make("balancing", render_mode="human")
    # A backend without a screen, called interactive: all but the window itself.
    monkeypatch.setattr(window, "_with_windows", lambda: ["agg"])
    others = set(plt.get_fignums())
    env = make("full-control", render_mode="human")
    env.reset(options={"angle": 0.0})
    begin = monotonic()
    for _ in range(40):
        env.step(1)
    assert 0.1 < monotonic() - begin < 2.0  # 40 steps of 5 ms, from the first picture on
    (number,) = set(plt.get_fignums()) - others
    (shown,) = plt.figure(number).axes[0].get_images()
    assert np.array_equal(
        shown.get_array()[:, :, 0] == 255,
        picture(Pendulum(), env.unwrapped.state, window.WIDTH)[:, :, 0] == 255,
    )
    plt.close(number)  # by hand
    env.reset()
    env.step(1)
    env.close()
    assert plt.get_fignums() == []


def python(script):
    return subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)


def test_gymnasium_finds_it_by_module_and_name():
    script = (
        "import gymnasium as g; print(g.make('upswing.physics.gym:upswing/FullControl-v0').spec.id)"
    )
    assert python(script).stdout == "upswing/FullControl-v0\n"
