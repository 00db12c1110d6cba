"""The Gymnasium environments with another pendulum, track and starts than the thesis's."""

import sys
import warnings
from types import ModuleType

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from tests.helpers import make_spec, run
from tests.unit.physics.test_gym import KINDS, make
from upswing.physics.environment import State
from upswing.physics.observation import largest_start
from upswing.physics.pendulum import Pendulum
from upswing.physics.picture import picture
from upswing.runs.simulation import streams
from upswing.study.task import task_named

OWN = {"length": 0.4, "accelerations": [-20, -10, 0, 10, 20], "time_step": 0.01}
"""Another pendulum, as a configuration writes it."""


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "more",
    [
        {},
        {"track": {"limit": 0.5}},
        {"track": {"limit": 0.5, "at_end": "falls"}},
        {"start": {"middle": -10, "within": 5, "velocity": 3}},
    ],
    ids=str,
)
def test_another_pendulum_steps_as_the_loop_does_with_it(kind, more):
    spec = make_spec(kind, "random", steps=2_000)
    own = task_named(kind, kind=kind, steps=2_000, pendulum=OWN, **more)
    spec = spec.model_copy(update={"task": own})
    trajectory, _ = run(spec, seed=1000)
    env = make(kind, **OWN, **more).unwrapped
    assert env.action_space == gymnasium.spaces.Discrete(5)
    _, env.np_random, *_ = streams(1000)
    _, info = env.reset()
    for t in range(2_000):
        for name, value in info.items():
            assert np.float32(value) == getattr(trajectory, name)[t], (name, t)
        observation, _, _, truncated, info = env.step(int(trajectory.action[t]))
        assert env.observation_space.contains(observation)
        assert truncated == bool(trajectory.reset[t])
        if truncated:
            _, info = env.reset()
    assert set(trajectory.action) == set(range(5))
    ends = abs(trajectory.cart_position) == 0.5
    assert (
        ends.any() == (more.get("track") == {"limit": 0.5} and kind == "full-control")
        or kind == "balancing"
    )


def test_another_pendulum_has_its_own_spaces_pictures_and_frames():
    env = make("full-control", **OWN, render_mode="rgb_array", track={"limit": 2.0})
    assert env.metadata["render_fps"] == 100
    assert make("full-control").metadata["render_fps"] == 200
    plain = make("full-control").unwrapped.observation_space.high[2]
    assert plain == pytest.approx(0.1 * 0.1 * np.hypot(9.81, 10) / 0.001)
    longer = make("full-control", length=0.4).unwrapped.observation_space.high[2]
    assert longer == pytest.approx(2 * plain)
    env.reset(options={"angle": 0.0})
    own = env.render()
    # A rod twice as long is drawn as large, with what is around it half as large.
    assert (own == picture(Pendulum(), State(0.0, 0.0, 0.0, 0.0)))[:60].all()
    assert (own[..., 0] == 178).sum() > 200  # the rod is whole, and all of it in the picture
    env.unwrapped.state = State(0.0, 0.0, 2.0, 0.0)
    row = env.render()[80]  # above the ground: the wall is beside the cart
    assert (np.flatnonzero(row[:, 0] < 170) > 130).all()
    assert (row[130:140] < 200).any()
    with pytest.raises(ValueError, match="must be 0, 1, 2, 3 or 4"):
        env.unwrapped.step(5)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"length": -1}, "pendulum: length: -1: must be greater than or equal to 0.01"),
        ({"lenght": 0.4}, "pendulum: lenght: unknown key: did you mean 'length'"),
        ({"accelerations": [10, -10]}, "pendulum: .*ascending order"),
        ({"track": {"limit": 0}}, "track: limit: 0: must be greater than 0"),
        ({"start": {"inside": 3}}, "start: inside: unknown key"),
    ],
)
def test_what_cannot_be_is_said_in_a_line(given, said):
    with pytest.raises(ValueError, match=said):
        make("balancing", **given)


@pytest.mark.parametrize("limit", [0.01, 0.1, 1.0, 30.0])
@pytest.mark.parametrize("own", [{}, {"friction": 0.02, "accelerations": [-5, 50]}], ids=str)
def test_no_jerk_at_the_ends_of_a_track_leaves_the_observation_space(own, limit):
    """Whoever pushes so as to add up the jerks, from the fastest start, stays within what was said."""
    env = make("full-control", **own, track={"limit": limit}).unwrapped
    largest, last = env.observation_space.high[2], env.action_space.n - 1
    fastest = largest_start(env.body, env.task)
    found = 0.0
    for period in (1, 3, 10, 60, 400):
        observation, _ = env.reset(options={"angle": 0.3, "angular_velocity": fastest})
        for t in range(2_000):
            observation, *_ = env.step(last if (t // period) % 2 else 0)
            found = max(found, abs(observation[2]))
            assert env.observation_space.contains(observation)
    assert fastest < largest < np.inf
    assert found > 0.3 * fastest


def test_without_friction_nothing_bounds_the_velocity():
    env = make("full-control", friction=0.0, track={"limit": 1.0}).unwrapped
    assert env.observation_space.high[2] == np.inf
    assert env.reset(options={"angular_velocity": 1e6})[0][2] == 1e6


def test_gymnasium_has_nothing_to_say_against_another_pendulum():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(
            make("full-control", **OWN, track={"limit": 2.0}).unwrapped, skip_render_check=True
        )
        check_env(make("balancing", accelerations=[-20, 20]).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("mode", ["sync", "async"])
def test_several_of_another_pendulum_step_as_one_does_and_can_be_seen(mode):
    asked = {**OWN, "track": {"limit": 0.5}, "start": {"middle": 180, "within": 10}}
    name = KINDS["full-control"]
    many = gymnasium.make_vec(
        name, num_envs=2, vectorization_mode=mode, render_mode="rgb_array", **asked
    )
    ones = [make("full-control", render_mode="rgb_array", **asked) for _ in range(2)]
    try:
        assert many.single_action_space == ones[0].action_space == gymnasium.spaces.Discrete(5)
        assert many.single_observation_space == ones[0].observation_space
        assert many.metadata["render_fps"] == 100
        observations, _ = many.reset(seed=5)
        assert (observations == [one.reset(seed=5 + i)[0] for i, one in enumerate(ones)]).all()
        for t in range(150):
            actions = np.array([(t // 5) % 5, 4 - (t // 7) % 5])
            seen, rewards, *_ = many.step(actions)
            told = [one.step(int(a)) for one, a in zip(ones, actions, strict=True)]
            assert (seen == [one[0] for one in told]).all()
            assert (rewards == [one[1] for one in told]).all()
        for picture_of_many, one in zip(many.render(), ones, strict=True):
            assert np.array_equal(picture_of_many, one.render())
    finally:
        many.close()


def test_a_film_of_another_pendulum_has_its_pictures_at_its_own_rate(tmp_path, monkeypatch):
    """What Gymnasium hands to moviepy, whether or not it is installed."""
    films = []

    class Film:
        def __init__(self, pictures, fps):
            films.append((pictures, fps))

        def write_videofile(self, path, **_):
            assert path.endswith(".mp4")

    module = ModuleType("moviepy.video.io.ImageSequenceClip")
    module.ImageSequenceClip = Film
    for part in ("moviepy", "moviepy.video", "moviepy.video.io"):
        monkeypatch.setitem(sys.modules, part, ModuleType(part))
    monkeypatch.setitem(sys.modules, module.__name__, module)
    plain = make("full-control", render_mode="rgb_array", **OWN)
    env = gymnasium.wrappers.RecordVideo(plain, tmp_path)
    env.reset(seed=0)
    shown = [plain.render()]
    for _ in range(20):
        env.step(4)
        shown.append(plain.render())
    env.close()
    ((pictures, fps),) = films
    assert fps == 100  # of 10 ms each: in real time
    assert np.array_equal(pictures, shown)
    assert not np.array_equal(pictures[0], pictures[-1])


def test_a_film_of_another_pendulum_can_be_taken(tmp_path):
    pytest.importorskip("moviepy", reason="moviepy, of the extra `video`, is not installed")
    plain = make("full-control", render_mode="rgb_array", **OWN)
    env = gymnasium.wrappers.RecordVideo(plain, tmp_path)
    env.reset(seed=0)
    for _ in range(20):
        env.step(4)
    env.close()
    (film,) = tmp_path.glob("*.mp4")
    from moviepy import VideoFileClip

    with VideoFileClip(str(film)) as taken:
        assert taken.fps == 100
        assert taken.duration == pytest.approx(0.21)
