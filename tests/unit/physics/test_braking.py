"""Whether a swing-up can be stopped, and what a run's arrivals come to."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.helpers import make_spec, run
from upswing.physics import pendulum
from upswing.physics.braking import (
    Stoppable,
    highest_stoppable_speed,
    mirrored,
    passes,
    stoppable_speeds,
)
from upswing.physics.environment import empty_trajectory
from upswing.physics.pendulum import FROM_HANGING, Pendulum
from upswing.physics.tasks import HORIZONTAL
from upswing.runs import metrics as measures


def test_the_highest_stoppable_speed_against_scipys_solver():
    """Backwards in time from rest where braking and gravity are in balance, to the horizontal."""
    body = Pendulum(time_step=1e-4)
    balance = np.arctan(10 / body.gravity)  # beyond it gravity wins, whatever the cart does

    def backwards(_, state):
        return -state[1], -pendulum.angular_acceleration(body, state[0], state[1], -10.0)

    def horizontal(_, state):
        return state[0] + HORIZONTAL

    horizontal.terminal = True
    solved = solve_ivp(
        backwards, (0, 20), (balance - 1e-7, 1e-9), events=horizontal, rtol=1e-10, atol=1e-12
    )
    exact = solved.y_events[0][0][1]
    assert highest_stoppable_speed(body) == pytest.approx(exact, rel=1e-3)
    # The thesis's own time step is coarse enough to show.
    assert highest_stoppable_speed(Pendulum()) == pytest.approx(exact, rel=0.02)


def test_without_friction_energy_says_the_same():
    body = Pendulum(friction=0.0, time_step=1e-5)
    balance = np.arctan(10 / body.gravity)
    work = 10 * (np.sin(balance) + 1) + body.gravity * np.cos(balance)  # per ½ml
    assert highest_stoppable_speed(body) == pytest.approx(np.sqrt(3 * work / body.length), rel=1e-3)


def test_faster_passes_and_slower_does_not():
    limit = highest_stoppable_speed(Pendulum())
    assert passes(Pendulum(), limit + 1e-6, HORIZONTAL)
    assert not passes(Pendulum(), limit - 1e-6, HORIZONTAL)


def test_no_other_braking_stops_what_full_braking_does_not():
    body, rng = Pendulum(), np.random.default_rng(0)
    speed = highest_stoppable_speed(body) + 0.2
    for _ in range(200):
        angle, velocity = -HORIZONTAL, speed
        while velocity > 0 and angle <= HORIZONTAL:
            action = rng.choice([-10.0, -10.0, -10.0, 0.0, 10.0])
            angle, velocity = pendulum.step(body, angle, velocity, float(action))
        assert velocity > 0


def test_under_hanging_gravity_gives_back_what_it_takes():
    """From −90° through the bottom to +90° only braking counts: its work is 2 × 10 per ½ml."""
    body = Pendulum(friction=0.0, time_step=1e-5, orientation=FROM_HANGING)
    assert highest_stoppable_speed(body) == pytest.approx(np.sqrt(3 * 20 / body.length), rel=1e-3)


def test_arrivals_are_counted_with_their_speed_at_the_horizontal():
    trajectory = empty_trajectory(6)
    trajectory.angle[:] = np.radians([100, 80, 95, 85, 170, -30])
    trajectory.angular_velocity[:] = [-20, -10, 1, -4, 0, 0]
    found = measures.measure(trajectory, False, Stoppable(12.0, 12.0))
    # half way from 100° to 80°: 15 rad/s; half way from 95° to 85°: 1.5; from 170° at rest: 0
    assert found.swing_ups == 3
    assert found.arrival_speed == pytest.approx((15 + 1.5 + 0) / 3, rel=1e-5)
    assert found.too_fast_share == pytest.approx(1 / 3)


def test_only_what_comes_up_to_20_degrees_has_recovered():
    degrees = [0, 100, 170, 80, 120, 60, 10, 5, 100, 10, -5, 95]
    trajectory = empty_trajectory(len(degrees) * 5)
    trajectory.angle[:] = np.radians([0] * (len(degrees) * 4) + degrees)
    found = measures.measure(trajectory, False, Stoppable(12.0, 12.0))
    # Below four times: after the first it passes the horizontal only, after the second and the third
    # it comes up, and the fourth is where the run ends.
    assert found.recovered_share == pytest.approx(2 / 4)


def test_a_run_without_arrivals_has_no_speed():
    trajectory, _ = run(make_spec("balancing", "table", steps=2_000))
    found = measures.measure(trajectory, True, Stoppable(15.0, 15.0))
    assert found.swing_ups == 0
    assert found.arrival_speed is None
    assert found.too_fast_share is None


def test_a_side_is_stopped_by_the_push_against_it():
    strong_left = Pendulum(accelerations=(-20.0, 0.0, 10.0))
    found = stoppable_speeds(strong_left)
    even = {
        push: highest_stoppable_speed(Pendulum(accelerations=(-push, 0.0, push)))
        for push in (10.0, 20.0)
    }
    assert found == pytest.approx((even[20.0], even[10.0]))
    assert highest_stoppable_speed(strong_left) == pytest.approx(even[10.0])
    assert stoppable_speeds(mirrored(strong_left)) == found[::-1]
    assert mirrored(Pendulum()) == Pendulum()


def test_an_arrival_is_too_fast_for_the_side_that_it_comes_from():
    angles = np.radians([-100.0, -80.0, -100.0, 100.0, 80.0]).astype(np.float32)
    speeds = np.array([15.0, 15.0, 0.0, -15.0, -15.0], np.float32)
    trajectory = empty_trajectory(5)._replace(angle=angles, angular_velocity=speeds)
    for limits, unstoppable in (((20, 10), 1), ((10, 20), 1), ((10, 10), 2), ((20, 20), 0)):
        found = measures.measure(trajectory, False, Stoppable(*map(float, limits)))
        assert (found.swing_ups, round(found.swing_ups * found.too_fast_share)) == (2, unstoppable)
