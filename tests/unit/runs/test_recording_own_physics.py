"""The recording of another pendulum: its own actions, sizes, time, track and tiles; read back from a file."""

from itertools import pairwise
from math import log10

import numpy as np
import pytest

from tests.helpers import beyond_spec
from tests.unit.runs.recorded import Recorded
from upswing.recordings.live import Plan
from upswing.runs.recording.actions import LEFT, NONE, RIGHT, action_colours
from upswing.runs.recording.axes import below, legend
from upswing.runs.recording.frames import (
    LONGEST_STRETCH,
    drawn_every,
    jumps,
    stretch_length,
)
from upswing.runs.recording.layout import run_layout
from upswing.runs.recording.pictures import grid_of, trail
from upswing.runs.recording.sizes import in_words, marks_apart
from upswing.runs.snapshots import Snapshots

PUSHES = (-20, -10, 0, 10, 20)
LIMIT = 1.0
OWN = {
    "pendulum": {"length": 0.4, "time_step": 0.01, "accelerations": PUSHES},
    "track": {"limit": LIMIT},
    "tiles": {"velocity_limit": 14, "angle_parts": 12},
}


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """A run of a pendulum that is none of the thesis's."""
    spec = beyond_spec(steps=20_000, task=OWN)
    return Recorded(tmp_path_factory.mktemp("recorded") / "run.rrd", spec)


def rows(recorded, entity, component):
    """Values of an entity by the step."""
    return {
        time["step"]: np.array(value)
        for time, value in recorded.columns[entity][component]
        if "step" in time
    }


def test_time_passes_by_its_own_steps(recorded):
    times = [time for time, _ in recorded.columns["/angle"]["Scalars:scalars"]]
    for time in times:
        assert time["sim_time"].total_seconds() == pytest.approx(time["step"] * 0.01)
    first = recorded.frames.named[0]
    assert first.after - first.first == 225  # 2.25 s


def test_actions_are_its_own(recorded):
    said = rows(recorded, "/action", "Scalars:scalars")
    found = {step: float(value[0]) for step, value in said.items() if np.isfinite(value[0])}
    assert set(found.values()) == set(map(float, PUSHES))
    assert all(PUSHES[recorded.trajectory.action[step]] == ẍ for step, ẍ in found.items())


def test_the_pendulum_is_as_long_as_it_is_and_drawn_50_times_a_second(recorded):
    rods = rows(recorded, "/pendulum/rod", "LineStrips2D:strips")
    assert list(rods)[:4] == [0, 2, 4, 6]
    for step, ((base, tip),) in rods.items():
        assert np.linalg.norm(tip - base) == pytest.approx(0.4, rel=1e-6)
        assert tip[1] == pytest.approx(-0.4 * np.cos(recorded.trajectory.angle[step]), abs=1e-6)


def test_the_arrow_is_scaled_by_the_strongest_push(recorded):
    arrows = rows(recorded, "/pendulum/push", "Arrows2D:vectors")
    lengths = {
        int(PUSHES[recorded.trajectory.action[step]]): round(float(value[0][0]), 6)
        for step, value in arrows.items()
    }
    # That of the thesis is half as long as its pendulum, and so is this.
    assert lengths == {-20: -0.2, -10: -0.1, 0: 0.0, 10: 0.1, 20: 0.2}


def test_the_ends_of_the_track_are_where_the_cart_stops(recorded):
    ((_, posts),) = recorded.columns["/pendulum/track"]["LineStrips2D:strips"]
    ((_, (half,)),) = recorded.columns["/pendulum/cart"]["Boxes2D:half_sizes"]
    assert [post[0][0] for post in posts] == pytest.approx([-LIMIT - half[0], LIMIT + half[0]])
    moved = rows(recorded, "/pendulum/track", "Transform3D:translation")
    positions = recorded.trajectory.cart_position
    assert abs(positions).max() == LIMIT
    for step, value in moved.items():
        assert value[0][0] == pytest.approx(-positions[step], abs=1e-6)


def test_an_endless_track_has_no_ends(tmp_path):
    plain = Recorded(tmp_path / "run.rrd", "balancing", "table", 0.5, 1_000)
    assert "/pendulum/track" not in plain.columns


def test_the_marks_pass_without_a_jump(recorded):
    ((_, marks),) = recorded.columns["/pendulum/ground"]["LineStrips2D:strips"]
    across = [mark[0][0] for mark in marks]
    np.testing.assert_allclose(np.diff(across), 0.2, atol=1e-6)
    for step, value in rows(recorded, "/pendulum/ground", "Transform3D:translation").items():
        apart = (recorded.trajectory.cart_position[step] + value[0][0]) / 0.2
        assert apart == pytest.approx(round(apart), abs=1e-5)


def test_the_axes_are_those_of_the_encoder_s_picture(recorded):
    ((_, labels),) = recorded.columns["/learned/marks"]["Points2D:labels"]
    assert {"−14", "−7", "+7", "+14", "−180°", "+90°"} <= set(labels)
    grid = grid_of(recorded.learned)
    assert grid.parts == (12, 20)
    for step, value in rows(recorded, "/phase/state", "Points2D:positions").items():
        angle, velocity = (
            float(column[step])
            for column in (recorded.trajectory.angle, recorded.trajectory.angular_velocity)
        )
        x, y = value[0]
        assert x == pytest.approx((angle / np.pi + 1) / 2 * grid.width, abs=1e-3)
        up = (np.clip(velocity, -14, 14) / 14 + 1) / 2
        assert y == pytest.approx((1 - up) * grid.height, abs=1e-3)


def test_the_map_shows_the_best_of_five_actions(recorded):
    import rerun as rr

    grid, q = grid_of(recorded.learned), recorded.learned.q[-1]
    pictures = [row for _, row in recorded.columns["/learned/policy"]["SegmentationImage:buffer"]]
    last = np.array(pictures[-1][0]).reshape(grid.height, grid.width)
    across, up = grid.pixels
    seen = last[::up, ::across][::-1].T
    best = q.max(axis=-1, keepdims=True) == q
    expected = np.where(best.sum(axis=-1) > 1, 2 * len(PUSHES), best.argmax(axis=-1))
    np.testing.assert_array_equal(seen, expected)
    assert len(np.unique(seen)) > 3
    ((_, classes),) = recorded.columns["/learned"]["AnnotationContext:context"]
    (listed,) = classes
    infos = [one["class_description"]["info"] for one in listed]
    assert [one["label"] for one in infos] == [
        "−20 m/s²", "−10 m/s²", "0 m/s²", "+10 m/s²", "+20 m/s²", "undecided",
    ]  # fmt: skip
    assert rr.components.Color(LEFT).rgba == infos[0]["color"]


def test_every_word_of_the_maps_is_shown_however_many_there_are(recorded):
    for entity in ("/phase/marks", "/learned/marks"):
        assert [row for _, row in recorded.columns[entity]["Points2D:show_labels"]] == [[True]]


def test_the_text_has_its_own_numbers(recorded):
    ((_, text),) = recorded.texts("/about", "TextDocument:text")
    for words in (
        "**100 frames a second",
        "marks on the ground are 20 cm apart",
        "The posts are the ends of the track, 1 m from its middle.",
        "Blue accelerates the cart by −20 m/s², pale by 0, orange by +20 m/s², and what is between by "
        "less",
        "2,500 steps (25 s)",
        "% of its last 4,000 steps",
        "| upright, last 50,000 steps [share] |",
        "| falls, first 2,500 steps |",
        "| falls, step 1,250 to 2,500 |",
    ):
        assert words in text
    assert "200 frames" not in text


def test_the_layout_has_its_own_speed_and_ranges(recorded, tmp_path):
    import rerun as rr

    path = tmp_path / "layout.rbl"
    run_layout(recorded.spec.task).save("upswing-own", path)
    reader = rr.chunk.RrdReader(path)
    (store,) = reader.blueprints()
    found = {}
    for chunk in reader.stream(store=store):
        batch = chunk.to_record_batch()
        for name in batch.schema.names:
            found.setdefault(name, []).append(batch[name].to_pylist())
    assert found["TimePanelBlueprint:fps"] == [[[100.0]]]
    ranges = [row for rows in found["ScalarAxis:range"] for (row,) in rows]
    assert pytest.approx([-22, 22]) in ranges
    assert pytest.approx([-1.1 * LIMIT, 1.1 * LIMIT]) in ranges


# Any number of actions.


def test_the_three_actions_of_the_thesis_keep_their_colours():
    assert action_colours((-10.0, 0.0, 10.0)) == ((0, 114, 178), (221, 221, 221), (213, 94, 0))


@pytest.mark.parametrize(
    "accelerations",
    [(-10.0, 10.0), PUSHES, (-1.0, 0.0, 1e-3, 2e-3, 50.0), tuple(map(float, range(-10, 11)))],
)
def test_colours_go_from_none_to_the_strongest_of_each_side(accelerations):
    colours = action_colours(accelerations)
    assert len(set(colours)) == len(accelerations)
    assert (colours[0], colours[-1]) == (LEFT, RIGHT)
    if 0 in accelerations:
        assert colours[accelerations.index(0)] == NONE
    far = [float(np.linalg.norm(np.subtract(colour, NONE))) for colour in colours]
    middle = [colour for colour, ẍ in zip(far, accelerations, strict=True) if ẍ > 0]
    assert all(one < other for one, other in pairwise(middle))


@pytest.mark.parametrize("modules", [1, 2])
@pytest.mark.parametrize("actions", [2, 3, 5, 6, 21])
def test_the_legend_names_every_action_and_finds_room(modules, actions):
    accelerations = tuple(np.linspace(-20, 20, actions).round(3).tolist())
    found = legend(modules, accelerations)
    for module in range(modules):
        for colour in action_colours(accelerations):
            darker = tuple(int(part * (1 - 0.25 * module)) for part in colour)
            assert darker in [one.colour for one in found]
    places = [(one.across, one.row) for one in found]
    assert len(set(places)) == len(places)
    assert 15 + 7 * (found[-1].row + 1) < below(actions)
    assert below(3) == 74  # as it is in the recordings of the thesis


# Any time step, any length, any number of tiles.


@pytest.mark.parametrize(
    ("time_step", "length", "every", "of_trail"),
    [
        (0.005, 450, 4, (24, 3)),
        (0.01, 225, 2, (24, 3)),
        (0.1, 22, 1, (5, 1)),
        (1e-4, 4_500, 200, (24, 3)),
    ],
)
def test_stretches_drawings_and_trails_are_as_long_in_time(time_step, length, every, of_trail):
    assert stretch_length(time_step) == length <= LONGEST_STRETCH
    assert drawn_every(time_step) == every
    assert trail(time_step) == of_trail
    drawn = Plan.of(np.ones(1_000, dtype=np.bool_), "all", time_step).drawn
    assert (np.diff(drawn) == every).all()


def test_a_fast_pendulum_in_long_steps_does_not_jump():
    turning = np.array([0.0, 80.0, 160.0, -120.0, -40.0])  # 800° a second
    assert jumps(turning, 0.1).tolist() == [False, False, False, True, False]
    assert jumps(turning, 0.005).tolist() == [False, True, True, True, True]


@pytest.mark.parametrize("length", [0.01, 0.05, 0.2, 0.37, 0.4, 1, 3.3, 100])
def test_marks_are_a_round_distance_near_half_of_the_pendulum(length):
    apart = marks_apart(length)
    assert length / 5 < apart <= length / 2 * (1 + 1e-9)
    digit = apart / 10 ** np.floor(log10(apart) + 1e-9)
    assert round(digit, 6) in (1, 2, 5)


def test_distances_are_said_as_one_says_them():
    assert [in_words(metres) for metres in (0.1, 0.005, 2.0)] == ["10 cm", "0.5 cm", "2 m"]


def test_a_map_of_many_tiles_fits_its_view():
    owner = np.zeros((720, 100), dtype=np.int64)
    many = Snapshots(np.array([0]), np.zeros((1, 720, 100, 2)), owner, np.pi, 20.0)
    grid = grid_of(many)
    assert grid.parts == (80, 50)
    assert max(grid.width, grid.height) <= 80
