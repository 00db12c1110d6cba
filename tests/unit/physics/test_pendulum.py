"""The pendulum against scipy's ODE solver, and against what physics says of it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from upswing.physics import pendulum
from upswing.physics.pendulum import (
    FROM_HANGING,
    FROM_UPRIGHT,
    Pendulum,
    ThesisActions,
    acceleration_of,
    body_of,
)
from upswing.study.physical import PendulumOptions

angles = st.floats(-np.pi, np.pi)
velocities = st.floats(-20, 20)
drives = st.sampled_from([-10.0, 0.0, 10.0])


def simulate(body, angle, velocity, drive, seconds):
    for _ in range(round(seconds / body.time_step)):
        angle, velocity = pendulum.step(body, angle, velocity, drive)
    return angle, velocity


def exact(body, angle, velocity, drive, seconds):
    def slope(_, state):
        return state[1], pendulum.angular_acceleration(body, state[0], state[1], drive)

    solved = solve_ivp(slope, (0, seconds), (angle, velocity), rtol=1e-11, atol=1e-12)
    return solved.y[:, -1]


def test_equation_21_by_hand():
    m, length, g, friction = 0.1, 0.2, 9.81, 0.001
    angle, velocity, drive = 0.7, -3.0, 10.0
    printed = (
        -m * g * length / 2 * np.sin(angle)
        - m * drive * length / 2 * np.cos(angle)
        - velocity * friction
    ) / (m * length**2 / 3)
    body = Pendulum(orientation=FROM_HANGING)
    assert pendulum.angular_acceleration(body, angle, velocity, drive) == pytest.approx(printed)


@pytest.mark.parametrize("orientation", [FROM_UPRIGHT, FROM_HANGING])
@pytest.mark.parametrize("drive", [-10.0, 0.0, 10.0])
def test_error_against_scipy_falls_with_dt_at_first_order(orientation, drive):
    errors = []
    steps = (0.005, 0.0025, 0.00125, 0.000625)
    for dt in steps:
        body = Pendulum(time_step=dt, orientation=orientation)
        mine = simulate(body, 0.4, 0.5, drive, 0.5)
        errors.append(np.abs(np.array(mine) - exact(body, 0.4, 0.5, drive, 0.5)).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders == pytest.approx(1.0, abs=0.15)


def test_small_swings_have_the_period_of_a_rod():
    body = Pendulum(friction=0.0, time_step=1e-4, orientation=FROM_HANGING)
    angle, velocity, crossings = 0.01, 0.0, []
    for t in range(40_000):
        before = angle
        angle, velocity = pendulum.step(body, angle, velocity, 0.0)
        if before > 0 >= angle:
            crossings.append(t + before / (before - angle))
    period = np.diff(crossings).mean() * body.time_step
    assert period == pytest.approx(
        2 * np.pi * np.sqrt(2 * body.length / (3 * body.gravity)), rel=1e-4
    )


def energy(body, angle, velocity):
    inertia = body.mass * body.length**2 / 3
    height = body.orientation * body.length / 2 * np.cos(angle)
    return inertia * velocity**2 / 2 + body.mass * body.gravity * height


def test_energy_without_friction_and_drive_does_not_drift():
    body = Pendulum(friction=0.0)
    angle, velocity = 2.0, 0.0
    first = energy(body, angle, velocity)
    energies = []
    for _ in range(20_000):
        angle, velocity = pendulum.step(body, angle, velocity, 0.0)
        energies.append(energy(body, angle, velocity))
    scale = body.mass * body.gravity * body.length
    error = (np.array(energies) - first) / scale
    assert np.abs(error).max() < 0.05  # of first order in dt …
    assert abs(error[-5_000:].mean() - error[:5_000].mean()) < 1e-3  # … and it goes round, not away


def test_friction_takes_energy_away():
    body = Pendulum()
    assert energy(body, *simulate(body, 2.0, 0.0, 0.0, 30.0)) == pytest.approx(
        -body.mass * body.gravity * body.length / 2, abs=1e-4
    )


@given(angles, velocities, drives)
def test_the_two_zeros_of_the_angle_are_one_pendulum(angle, velocity, drive):
    upright = pendulum.angular_acceleration(Pendulum(), angle, velocity, drive)
    hanging = pendulum.angular_acceleration(
        Pendulum(orientation=FROM_HANGING), angle + np.pi, velocity, drive
    )
    assert upright == pytest.approx(hanging, abs=1e-9)


@given(angles, velocities, drives)
def test_a_step_is_semi_implicit_euler(angle, velocity, drive):
    body = Pendulum()
    new_angle, new_velocity = pendulum.step(body, angle, velocity, drive)
    assert new_angle == pytest.approx(angle + new_velocity * body.time_step, abs=1e-12)


def test_cart_follows_equations_24_and_25():
    position, velocity = pendulum.step_cart(Pendulum(), 1.0, 2.0, 10.0)
    assert position == pytest.approx(1.0 + 2.0 * 0.005 + 10.0 * 0.005**2)
    assert velocity == pytest.approx(2.05)


def test_the_thesiss_actions_are_known_and_others_asked_for():
    thesis = body_of(PendulumOptions())
    assert isinstance(thesis.accelerations, ThesisActions)
    assert thesis == Pendulum()
    other = body_of(PendulumOptions(accelerations=(-20, -5, 0, 5, 20))).accelerations
    assert not isinstance(other, ThesisActions)
    assert [acceleration_of(thesis.accelerations, action) for action in range(3)] == [-10, 0, 10]
    assert [acceleration_of(other, action) for action in range(5)] == [-20, -5, 0, 5, 20]
