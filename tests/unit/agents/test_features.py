"""Feature encoders beyond the thesis's grid: every state has its places, and neighbours share what they should."""

from math import pi

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from upswing.agents.features import Place, Plan, Point, create, locate
from upswing.agents.features.tilings import TILINGS
from upswing.physics import tasks
from upswing.runs.snapshots import places
from upswing.study.loading import parts
from upswing.study.readings import Readings

KINDS = ["balancing", "full-control"]
OPTIONS = {"modular": False, "cuts": 4, "entries": 160, "width": 1.0, "radius": 1.5}
NO_TILES = ("continuous", "radial", "circles")
ANGLES = st.floats(-pi, pi, exclude_max=True)
SPEEDS = st.floats(-40, 40)


def encoder(name, kind="full-control", **readings):
    task = tasks.create(kind, Readings(**readings))
    return create(name, Plan(task, OPTIONS, Readings(**readings)))


@pytest.mark.parametrize("name", [name for name in parts("features") if name not in NO_TILES])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("wrap", ["wrapped", "unbounded"])
@given(angle=st.floats(-30, 30), speed=SPEEDS)
def test_every_state_has_tiles_that_are_there(name, kind, wrap, angle, speed):
    one = encoder(name, kind, wrap=wrap)
    place = locate(one, angle, speed)
    assert 0 <= place.module < one.modules
    assert all(0 <= tile < one.tiles for tile in place.tiles)
    assert len(set(place.tiles)) == len(place.tiles)


@pytest.mark.parametrize("name", parts("features"))
@pytest.mark.parametrize("kind", KINDS)
def test_the_compiled_coding_is_the_one_in_python(name, kind):
    from upswing.physics.jit import compiled

    @compiled
    def answer(one, angle, speed):
        return locate(one, angle, speed)

    one = encoder(name, kind)
    for angle, speed in np.random.default_rng(0).uniform(-1, 1, (50, 2)) * (pi, 25):
        assert answer(one, angle, speed) == locate(one, angle, speed)


@given(angle=ANGLES, speed=SPEEDS)
def test_fine_tiles_lie_in_those_of_the_thesis(angle, speed):
    fine, coarse = (
        encoder("fine"),
        encoder("grid"),
    )
    row, column = divmod(locate(fine, angle, speed).tiles[0], fine.velocity_parts)
    (tile,) = locate(coarse, angle, speed).tiles
    assert (row // 4, column // 4) == divmod(tile, 20)


def test_fine_tiles_of_one_cut_more_are_as_many_as_they_should_be():
    assert encoder("fine").tiles == 32 * 80
    assert encoder("fine", "balancing").tiles == 16 * 80


def test_hashing_depends_on_the_fine_tile_alone_and_uses_all_entries_about_equally():
    hashed = encoder("hashed")
    counts = np.zeros(hashed.entries)
    fine_of = {}
    for place, fine_place in zip(places(hashed), places(encoder("fine")), strict=True):
        counts[place.tiles[0]] += 1
        fine_of.setdefault(fine_place.tiles, set()).add(place.tiles)
    assert all(len(entries) == 1 for entries in fine_of.values())
    # 2,560 tiles over 160 entries: 16 each, with a spread of about 4 if they fell by chance.
    assert counts.min() >= 4
    assert counts.max() <= 32


def test_hashing_scatters_neighbours():
    hashed = encoder("hashed")
    entries = np.array([place.tiles[0] for place in places(hashed)]).reshape(32, 80)
    assert np.mean(entries[:, 1:] == entries[:, :-1]) < 0.05
    assert np.mean(entries[1:] == entries[:-1]) < 0.05


@given(angle=ANGLES, speed=st.floats(-19, 19))
@example(angle=3.1415926535897927, speed=0.0)  # (φ + π) / (2π/8) rounds up to 8
@example(angle=-pi, speed=0.0)
def test_the_first_tiling_is_the_grid_of_the_thesis(angle, speed):
    (first, *_) = locate(encoder("tilings"), angle, speed).tiles
    (tile,) = locate(encoder("grid"), angle, speed).tiles
    assert divmod(first, 21) == divmod(tile, 20)


@pytest.mark.parametrize(
    "name", [name for name in parts("features") if name not in (*NO_TILES, "boxes")]
)
@pytest.mark.parametrize("kind", KINDS)
def test_the_last_angle_below_the_limit_lies_in_the_last_part_and_the_limit_begins_the_first(
    name, kind
):
    one = encoder(name, kind)
    limit = one.grid.angle_limit if name == "hashed" else one.angle_limit
    for edge, inside in ((np.nextafter(limit, 0.0), limit - 1e-6), (-limit, -limit + 1e-6)):
        assert locate(one, float(edge), 0.5) == locate(one, float(inside), 0.5)


@given(angle=st.floats(-pi + 1e-9, pi - 1e-9), speed=st.floats(-17, 17))
def test_states_share_more_tilings_the_nearer_they_are(angle, speed):
    tilings = encoder("tilings")

    def shared(a, b):
        return len(set(locate(tilings, *a).tiles) & set(locate(tilings, *b).tiles))

    here = (angle, speed)
    around = (angle + pi) % (2 * pi) - pi
    assert shared(here, (around, speed)) == TILINGS
    eighth = 2.0 / 8 * 0.99
    assert shared(here, (angle, speed + eighth)) >= TILINGS - 1
    assert shared(here, (angle, speed + 2.01)) == 0
    half = (angle + pi / 8 + pi) % (2 * pi) - pi
    assert 3 <= shared(here, (half, speed)) <= 5


def test_tilings_tell_apart_what_one_grid_cannot():
    tilings, grid = (
        encoder("tilings"),
        encoder("grid"),
    )
    speeds = np.linspace(0.01, 1.99, 200)
    assert len({locate(grid, 0.1, speed) for speed in speeds}) == 1
    assert len({locate(tilings, 0.1, speed) for speed in speeds}) == TILINGS


def test_tilings_come_round_only_where_the_angle_does():
    just_below, just_above = (pi - 1e-6, 0.5), (-pi + 1e-6, 0.5)
    for wrap, common in (("wrapped", TILINGS - 1), ("unbounded", 0)):
        tilings = encoder("tilings", wrap=wrap)
        one, other = (set(locate(tilings, *state).tiles) for state in (just_below, just_above))
        assert len(one & other) == common


def test_the_state_itself_is_told_as_it_is():
    assert locate(encoder("continuous"), 0.25, -3.5) == Point(0, 0.25, -3.5)


def test_a_picture_covers_the_grid():
    assert places(encoder("tilings"))[0] != places(encoder("tilings"))[-1]
    assert places(encoder("grid")) == [Place(0, (tile,)) for tile in range(160)]
