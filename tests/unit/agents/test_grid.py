"""Every state has one tile, and two modules share the grid of one table."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from upswing.agents.features import Place, locate
from upswing.agents.features.grid import (
    BALANCING_MODULE,
    UPSWING_MODULE,
    Columns,
    ThesisColumns,
    Tiles,
    tiles_for,
)
from upswing.physics import tasks
from upswing.study.physical import TileOptions
from upswing.study.readings import Readings

angles = st.floats(-np.pi, np.pi, exclude_max=True)
any_angles = st.floats(-50, 50)
velocities = st.floats(-60, 60)


def grid_of(kind, modular, readings):
    return tiles_for(tasks.create(kind, readings), modular, readings)


encoders = st.builds(
    grid_of,
    st.sampled_from(["balancing", "full-control"]),
    st.booleans(),
    st.builds(Readings, angle_unit=st.sampled_from(["half_turn", "radians"])),
)
HALF_TURN, RADIANS = Readings(), Readings(angle_unit="radians")


@given(encoders, any_angles, velocities)
def test_every_state_has_a_tile_of_an_existing_module(tiles, angle, velocity):
    module, (tile,) = locate(tiles, angle, velocity)
    assert 0 <= module < tiles.modules
    assert 0 <= tile < tiles.tiles == (80 if tiles.modular or tiles.angle_parts == 4 else 160)


@pytest.mark.parametrize(
    ("kind", "parts", "limit"), [("balancing", 4, np.pi / 2), ("full-control", 8, np.pi)]
)
def test_half_turn_tiles_are_45_degrees_by_2_radians_a_second(kind, parts, limit):
    tiles = grid_of(kind, False, HALF_TURN)
    for row in range(parts):
        for column in range(20):
            low = np.array([-limit + row * np.pi / 4, -20 + 2 * column])
            for share in (1e-9, 0.5, 1 - 1e-9):
                state = low + share * np.array([np.pi / 4, 2])
                assert locate(tiles, *state) == Place(0, (20 * row + column,))


def test_radians_leaves_half_of_the_balancing_tiles_unvisited():
    tiles = grid_of("balancing", False, RADIANS)
    rows = {
        locate(tiles, angle, 0.0).tiles[0] // 20
        for angle in np.linspace(-np.pi / 2, np.pi / 2, 99)[:-1]
    }
    assert rows == {1, 2}


@given(any_angles)
def test_velocities_out_of_range_have_the_edge_tile(angle):
    tiles = grid_of("full-control", False, HALF_TURN)
    assert locate(tiles, angle, 1e9) == locate(tiles, angle, 19.9)
    assert locate(tiles, angle, -1e9) == locate(tiles, angle, -20.0)


@given(angles, velocities)
def test_a_fixed_control_structure_divides_at_the_horizontal(angle, velocity):
    for readings in (HALF_TURN, RADIANS):
        module, _ = locate(grid_of("full-control", True, readings), angle, velocity)
        above = -np.pi / 2 <= angle < np.pi / 2
        assert module == (BALANCING_MODULE if above else UPSWING_MODULE)


def test_two_modules_are_one_grid_under_another_name():
    one, two = (
        grid_of("full-control", False, HALF_TURN),
        grid_of("full-control", True, HALF_TURN),
    )
    pairs = set()
    for angle in np.linspace(-np.pi, np.pi, 801):
        for velocity in np.linspace(-22, 22, 89):
            pairs.add((locate(one, angle, velocity), locate(two, angle, velocity)))
    assert len(pairs) == 160
    assert len({a for a, _ in pairs}) == len({b for _, b in pairs}) == 160


def test_a_balancing_module_has_the_tiles_of_the_balancing_task():
    alone, module = (
        grid_of("balancing", False, HALF_TURN),
        grid_of("full-control", True, HALF_TURN),
    )
    for angle in np.linspace(-np.pi / 2, np.pi / 2, 101)[:-1]:
        assert locate(alone, angle, 3.0).tiles == locate(module, angle, 3.0).tiles


def test_a_tile_includes_its_lower_edge():
    tiles = Tiles(4, 2.0, Columns(20, 20.0), 2, False)
    assert locate(tiles, 0.0, 0.0) == Place(0, (2 * 20 + 10,))
    assert locate(tiles, -1e-9, -1e-9) == Place(0, (1 * 20 + 9,))


@pytest.mark.parametrize("modular", [False, True])
def test_what_is_known_while_compiling_changes_no_tile(modular):
    known = grid_of("full-control", modular, HALF_TURN)
    assert isinstance(known.columns, ThesisColumns)
    asked = known._replace(columns=Columns(20, 20.0))
    rng = np.random.default_rng(3)
    for angle, velocity in rng.uniform((-4, -30), (4, 30), (2_000, 2)).tolist():
        assert locate(known, angle, velocity) == locate(asked, angle, velocity)
    for velocity in np.arange(-22.0, 23.0):
        assert locate(known, 0.1, velocity) == locate(asked, 0.1, velocity)


def test_other_tiles_of_the_velocity_are_those_asked_for():
    task = tasks.create("full-control", HALF_TURN)
    options = TileOptions(velocity_parts=4, velocity_limit=8)
    tiles = tiles_for(task, False, HALF_TURN, options)
    columns = [
        locate(tiles, 0.0, velocity).tiles[0] % 4 for velocity in (-99, -8, -4.1, -3.9, 3, 5, 99)
    ]
    assert columns == [0, 0, 0, 1, 2, 3, 3]
