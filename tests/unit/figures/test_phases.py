"""What the pendulum does, in a word: runs of which it is known."""

import numpy as np
import pytest

from upswing.figures.panels import ANGLES, TURN, angle_histogram
from upswing.figures.phases import goes_over, held, meaning, phases
from upswing.figures.style import plt
from upswing.physics.pendulum import Pendulum, angular_acceleration, energy
from upswing.physics.tasks import HORIZONTAL

BODY = Pendulum()
STRONG = Pendulum(length=0.4, accelerations=(-20.0, -10.0, 0.0, 10.0, 20.0), time_step=0.01)
HELD = held(BODY)[0]
N = 4_000
WHEN = np.arange(N) / N
NOISE = np.random.default_rng(0).normal(0, 2, N)
REST = np.zeros(N)
SWINGS = 180 + 100 * np.sin(np.arange(N) / 7)


@pytest.mark.parametrize(
    ("angle", "speed", "expected"),
    [
        (NOISE, REST, [("stands", 0)]),
        (np.where(NOISE > 0, -180, 180) + NOISE, REST, [("hangs", 180)]),
        (HELD + NOISE, REST, [("runs away", HELD)]),
        (-HELD + NOISE, REST, [("runs away", 360 - HELD)]),
        (np.arange(N) * 77.0, REST + 25, [("spins", 180)]),
        (SWINGS, REST, [("swings", 180)]),
        (np.where(WHEN < 0.5, 180 + NOISE, NOISE), REST, [("stands", 0), ("hangs", 180)]),
        (np.where(WHEN < 0.04, NOISE, 180), REST, [("hangs", 180)]),  # too short to be named
    ],
)
def test_what_it_does_is_named(angle, speed, expected):
    found = phases(np.mod(angle + 180, 360) - 180, speed, WHEN, BODY)
    assert [(one.name, one.angle) for one in found] == [
        (name, pytest.approx(where)) for name, where in expected
    ]
    assert all(one.last - one.first >= 0.05 for one in found)


def test_a_phase_is_named_where_it_lasts_longest():
    angle = np.where((WHEN > 0.1) & (WHEN < 0.2), NOISE, 180)
    angle[WHEN > 0.6] = 0
    (stands, _) = phases(angle, REST, WHEN, BODY)
    assert (stands.first, stands.last) == pytest.approx((0.6, 1.0), abs=0.03)


@pytest.mark.parametrize("body", [BODY, STRONG])
def test_it_goes_over_the_top_with_more_energy_than_it_has_there(body):
    draws = np.random.default_rng(1)
    for angle, speed in zip(draws.uniform(-180, 180, 500), draws.normal(0, 15, 500), strict=True):
        above = energy(body, np.radians(angle), speed) > energy(body, 0.0, 0.0)
        assert bool(goes_over(np.array([angle]), np.array([speed]), body)[0]) == above


@pytest.mark.parametrize(
    "body", [BODY, STRONG, BODY._replace(accelerations=(-3.0, 15.0)), BODY._replace(gravity=1.6)]
)
def test_the_held_angle_is_where_nothing_moves_the_rod_and_to_where_it_comes_back(body):
    """By the pendulum's own equation, eq. 21, under the strongest push to the right and to the left."""
    right, left = np.radians(held(body))
    for angle, push in ((right, body.accelerations[-1]), (-left, body.accelerations[0])):
        assert angular_acceleration(body, angle, 0.0, push) == pytest.approx(0, abs=1e-9)
        assert angular_acceleration(body, angle + 0.1, 0.0, push) < 0
        assert angular_acceleration(body, angle - 0.1, 0.0, push) > 0
        assert abs(angle) > HORIZONTAL


def test_a_task_with_stronger_pushes_is_held_elsewhere():
    assert [round(angle) for angle in held(STRONG)] == [116, 116]
    (away,) = phases(-116 + NOISE, REST, WHEN, STRONG)
    assert (away.name, round(away.angle)) == ("runs away", 244)
    assert all(one.name != "runs away" for one in phases(-116 + NOISE, REST, WHEN, BODY))
    uneven = BODY._replace(accelerations=(-3.0, 15.0))
    assert [one.name for one in phases(123 + NOISE, REST, WHEN, uneven)] == ["runs away"]
    assert [one.name for one in phases(-163 + NOISE, REST, WHEN, uneven)] == ["runs away"]
    assert "holds the rod 134° from upright)" in meaning("runs away", [BODY, BODY])
    assert "holds the rod 116° or 134° from upright)" in meaning("runs away", [BODY, STRONG])
    assert meaning("stands", [BODY]) == "it stands"


def test_hanging_is_drawn_whole(study):
    """Upright and hanging each fill one row of the picture, in the middle of it, wherever ±180° is cut."""
    assert TURN[1] - TURN[0] == 360
    for middle in (0, 180):
        assert (middle - TURN[0]) / 360 * ANGLES % 1 == pytest.approx(0.5)
    cell = "full-control/idle/alpha-none"
    run = study.median_run(cell)
    hanging = np.where(np.arange(len(run.trajectory)) % 2, np.pi - 0.02, -np.pi + 0.02)
    figure, axes = plt.subplots()
    (phase,) = angle_histogram(axes, run._replace(trajectory=run.trajectory.assign(angle=hanging, angular_velocity=0.0)), cell)  # fmt: skip
    assert phase.name == "hangs"
    shares = axes.images[0].get_array()
    assert (np.count_nonzero(shares, axis=0) == 1).all()
    row = int(np.flatnonzero(shares[:, 0])[0])
    assert row == int((180 - TURN[0]) / 360 * ANGLES)
    figure.canvas.draw()
    words = [label.get_text() for label in axes.get_yticklabels()]
    assert {"upright", "hanging"} <= set(words)
    plt.close(figure)
