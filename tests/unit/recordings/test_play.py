"""Playing what a run learned: from a start, with a push, in a viewer, as a slide."""

import sys
import time
from dataclasses import replace
from math import inf

import numpy as np
import pytest
from PIL import Image

from tests.helpers import beyond_spec, make_spec
from tests.unit.recordings.test_browsing import DRIVERS
from tests.unit.recordings.test_watch import rows
from upswing.cli.main import main
from upswing.physics.environment import empty_trajectory
from upswing.physics.pendulum import FROM_HANGING, FROM_UPRIGHT, Pendulum
from upswing.recordings import play as play_module
from upswing.recordings.play import Start, follow, in_words, learned_of
from upswing.recordings.screenshots import headless_viewer, wait_until_loaded
from upswing.recordings.slide import HEIGHT, WIDTH, Slide
from upswing.runs.learned import Learned
from upswing.runs.simulation import prepare
from upswing.runs.train import train
from upswing.study.errors import BadInput

GOOD = beyond_spec(alpha=1, steps=50_000, discount=0.97, learner="table", coding="tilings").of_seed(
    5001
)  # it solves full control, in the study beyond the thesis
BALANCES = make_spec("balancing", "table", 0.1, steps=5_000)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a run that swings up and one that balances."""
    folder = tmp_path_factory.mktemp("learned")
    for spec in (GOOD, BALANCES):
        train(spec, folder)
    return folder


@pytest.fixture(scope="module")
def good(folder):
    return learned_of(GOOD.run(5001), folder)


def test_a_good_policy_gets_up_from_hanging_and_stands(good):
    played = follow(good, Start(179))
    assert np.degrees(played.trajectory.angle[0]) == pytest.approx(179)
    assert np.abs(np.degrees(played.trajectory.angle[-1_000:])).max() < 20
    said = in_words(played)
    assert said.startswith("It was upright after ")
    assert "At the end, it stands: upright for 100 % of the last 5 s." in said
    after = float(said.removeprefix("It was upright after ").split()[0])
    first = round(after / 0.005)
    assert played.upright[first : first + 100].all()
    assert not played.upright[first - 1]


def test_a_push_is_added_to_the_angular_velocity_when_it_is_said(good):
    calm, pushed = follow(good, Start(10)), follow(good, Start(10, push=2, at=5))
    for column in ("angle", "angular_velocity", "action"):
        same = getattr(calm.trajectory, column)[:1_000]
        np.testing.assert_array_equal(getattr(pushed.trajectory, column)[:1_000], same)
    speeds = [one.trajectory.angular_velocity[1_000] for one in (calm, pushed)]
    assert speeds[1] - speeds[0] == pytest.approx(2, abs=1e-5)
    assert "The push of +2 rad/s at 5 s: it " in in_words(pushed)
    assert "push" not in in_words(calm)


def test_the_velocity_at_the_start_is_that_of_the_first_step(good):
    played = follow(good, Start(-90, velocity=3, seconds=1))
    assert played.trajectory.angular_velocity[0] == 3
    assert played.steps == 200


def test_a_fall_ends_the_task_that_it_ends(folder):
    learned = learned_of(BALANCES.run(0), folder)
    played = follow(learned, Start(85))
    assert played.ends_in_fall
    assert played.steps < 100
    assert f"It fell at {played.steps * 0.005:.2f} s, which ends balancing." in in_words(played)
    stands = follow(learned, Start(5))
    assert in_words(stands).startswith("It stayed upright, at most ")


def test_another_pendulum_keeps_its_own_time():
    own = {"length": 0.4, "time_step": 0.01, "accelerations": (-20, -10, 0, 10, 20)}
    spec = beyond_spec(steps=500, task={"pendulum": own})
    setting = prepare(spec, 0)
    setting.advance(empty_trajectory(500), 0, 500)
    learned = Learned(spec, setting.learner.learned)
    calm, pushed = (
        follow(learned, Start(10, push=push, at=1, seconds=3)).trajectory for push in (0, 2)
    )
    assert len(calm.angle) == 300
    np.testing.assert_array_equal(calm.angle[:100], pushed.angle[:100])
    change = pushed.angular_velocity[100] - calm.angular_velocity[100]
    assert change == pytest.approx(2, abs=1e-5)
    played = follow(learned, Start(10, push=2, at=1, seconds=3))
    assert "The push of +2 rad/s at 1 s: " in in_words(played)
    # Upright for half a second, and no shorter.
    for steps, said in ((50, "It was upright after 1.00 s."), (49, "It did not get upright.")):
        angle = np.full(300, np.pi, np.float32)
        angle[100 : 100 + steps] = 0
        moved = played.trajectory._replace(angle=angle)
        after = in_words(played._replace(trajectory=moved, start=Start(180, seconds=3)))
        assert after.startswith(said)
    with pytest.raises(BadInput, match=r"--seconds: 0\.001: must be a time from 0\.01 to 600 s"):
        follow(learned, Start(10, seconds=0.001))


@pytest.mark.parametrize(
    ("at_end", "limit", "said"),
    [
        ("falls", 0.05, "The cart came to the end of its track at "),
        ("falls", 1e5, "It fell at "),
        ("stops", 0.05, "It fell at "),
    ],
)
def test_an_end_of_the_track_where_the_task_ends_is_said(at_end, limit, said):
    track = {"limit": limit, "at_end": at_end}
    spec = beyond_spec("balancing", task={"track": track}, readings={"ties": "first"})
    learned = Learned(spec, prepare(spec, 0).learner.learned)  # which pushes to the left for ever
    played = follow(learned, Start(-5, seconds=5))
    assert played.ends_in_fall
    assert in_words(played).split(". ")[-1].startswith(said)


@pytest.mark.parametrize("time_step", [0.005, 0.01, 0.003, 0.0001, 0.1])
def test_pictures_follow_each_other_in_real_time(time_step):
    steps = round(3 / time_step)
    slide = Slide(Pendulum(time_step=time_step), empty_trajectory(steps), None, 180)
    times = np.array(slide.in_real_time) * time_step
    assert len(times) == 75
    due = np.minimum(0.04 * np.arange(75), (steps - 1) * time_step)
    assert np.abs(times - due).max() <= time_step * (0.5 + 1e-9)


def test_a_slide_shows_a_long_pendulum_whole_and_the_end_of_its_track():
    trajectory = empty_trajectory(10)
    slides = [
        np.asarray(Slide(Pendulum(length=length), trajectory, None, 180, track).moment(0)).astype(
            int
        )
        for length, track in ((0.2, inf), (2.0, inf), (2.0, 1.0))
    ]
    np.testing.assert_allclose(slides[0], slides[1], atol=100)  # but for how lines are rounded
    assert (np.abs(slides[2] - slides[1]) > 100).sum() > 100


def test_a_run_that_diverged_is_said_to_mean_nothing(good):
    arrays = {name: np.full_like(array, np.nan) for name, array in good.arrays.items()}
    assert in_words(follow(replace(good, arrays=arrays), Start(10))).startswith("The run diverged")


@pytest.mark.parametrize(
    ("start", "words"),
    [
        (Start(181), "--from: 181: must be from −180° to 180°"),
        (Start(float("nan")), "--from: nan: must be"),
        (Start(0, velocity=1e9), "--velocity: 1e+09: must be from −100 to 100 rad/s"),
        (Start(0, push=-101), "--push: -101: must be from −100 to 100 rad/s"),
        (Start(0, seconds=0), "--seconds: 0: must be a time from 0.005 to 600 s"),
        (Start(0, seconds=float("inf")), "--seconds: inf: must be"),
        (Start(0, push=1, at=20), "--at: 20: must be a time before the end, 20 s"),
        (Start(0, push=1, at=-1), "--at: -1: must be"),
    ],
)
def test_a_start_that_there_is_not_is_explained(good, start, words):
    with pytest.raises(BadInput) as caught:
        follow(good, start)
    assert words in str(caught.value)


def test_a_task_that_ends_beyond_the_horizontal_is_not_started_there(folder):
    with pytest.raises(BadInput, match="from −90° to 90°: balancing ends beyond it"):
        follow(learned_of(BALANCES.run(0), folder), Start(91))


def asked(folder, *words):
    return main(["play", *words, "--results", str(folder)])


def test_a_gif_plays_in_real_time(folder, tmp_path, capsys):
    path = tmp_path / "slide.gif"
    assert asked(folder, GOOD.run(5001), "--from", "179", "--push", "6", "--at", "3", "--seconds", "4",
                 "--to", str(path)) == 0  # fmt: skip
    with Image.open(path) as image:
        assert image.n_frames == 100
        durations = []
        for frame in range(image.n_frames):
            image.seek(frame)
            durations.append(image.info["duration"])
        assert set(durations) == {40}
        assert sum(durations) == 4_000
        assert image.info["loop"] == 0
        assert image.size[0] == WIDTH
    assert path.stat().st_size < 1_000_000
    assert "The push of +6 rad/s at 3 s" in capsys.readouterr().out
    assert [one.name for one in tmp_path.iterdir()] == ["slide.gif"]


@pytest.mark.parametrize(
    ("run", "start"), [(GOOD.run(5001), "from 180°"), (BALANCES.run(0), "from -20° for 20 s")]
)
def test_without_a_start_it_is_that_of_the_task(folder, tmp_path, capsys, run, start):
    assert asked(folder, run, "--to", str(tmp_path / "slide.rrd")) == 0
    assert start in capsys.readouterr().out


def test_a_png_shows_some_moments(folder, tmp_path):
    path = tmp_path / "slide.png"
    assert asked(folder, GOOD.run(5001), "--seconds", "2", "--to", str(path)) == 0
    with Image.open(path) as image:
        assert image.size[0] == 2 * WIDTH
        assert getattr(image, "n_frames", 1) == 1
        assert len(image.convert("RGB").getcolors(1 << 20)) > 20


def test_a_recording_has_every_step(folder, tmp_path):
    path = tmp_path / "played.rrd"
    weights = folder / "runs" / f"{GOOD.run(5001)}.weights.safetensors"
    assert asked(folder, str(weights), "--push", "1", "--to", str(path)) == 0
    found = rows(path)
    assert [step for step, _ in found["/angle", "Scalars:scalars"]] == list(range(4_001))
    assert len(found["/stretch", "StateChange:state"]) == 2  # before and after the push


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--to", "slide.mp4"], "no encoder for MP4 here; a .gif moves as well"),
        (["--to", "slide.jpeg"], "--to: slide.jpeg: must end with .gif, .png or .rrd"),
        (["--from", "200", "--to", "slide.gif"], "--from: 200: must be from"),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(
    folder, tmp_path, monkeypatch, capsys, words, said
):
    monkeypatch.chdir(tmp_path)
    assert asked(folder, GOOD.run(5001), *words) == 2
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_there_is_not_is_named(folder, capsys):
    assert asked(folder, "full-control/table/alpha-1/seed-9", "--to", "slide.gif") == 2
    assert "seed-9.weights.safetensors: missing" in capsys.readouterr().err


def test_without_a_display_it_says_what_to_do(folder, monkeypatch, capsys):
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(sys, "platform", "linux")
    assert asked(folder, GOOD.run(5001)) == 2
    assert "there is no display here; --web serves a page instead" in capsys.readouterr().err


@pytest.mark.parametrize("orientation", [FROM_UPRIGHT, FROM_HANGING])
def test_a_slide_shows_the_pendulum_where_it_is(good, orientation):
    """φ = 0 is upright, or hanging where φ is measured from there (R1)."""
    played = follow(good, Start(0, seconds=0.1))
    slide = Slide(Pendulum(orientation=orientation), played.trajectory, None, 180)
    pixels = np.asarray(slide.moment(0))[:HEIGHT]
    red = (pixels[..., 0] > 150) & (pixels[..., 1] < 80) & (pixels[..., 2] < 80)
    height = np.flatnonzero(red.any(axis=1)).mean()
    above = height < 0.6 * HEIGHT
    assert above == (orientation == FROM_UPRIGHT)
    assert slide.in_real_time == [0, 8, 16]


@pytest.mark.skipif(not DRIVERS, reason="no Vulkan driver: install mesa-vulkan-drivers")
def test_a_headless_viewer_plays_it_without_a_problem(good, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    played = follow(good, Start(180, push=2))
    with headless_viewer() as viewer:
        live = play_module._live(played)
        live.stream.connect_grpc(viewer.url)
        play_module._draw(live, played)
        live.end()
        wait_until_loaded(viewer)
        times = []
        for _ in range(2):
            time.sleep(1)
            state = viewer.get_state()
            times.append(state.recordings[0].current_time)
        assert [view.reports for view in state.views if view.reports] == []
        assert times[0] != times[1]  # it is playing
        assert len(viewer.take_screenshot()) > 20_000
