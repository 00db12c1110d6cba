"""Controllers: the regulator is scipy's, the fuzzy surface a plain transcription's, and both do their task."""

import numpy as np
import pytest
from pydantic import ValidationError
from scipy.interpolate import RegularGridInterpolator
from scipy.linalg import solve_discrete_are

from tests.helpers import beyond_spec, run
from tests.oracles import controllers
from tests.paths import ROOT
from upswing.agents.features import Point
from upswing.agents.learners import energy_lqr, fuzzy, values
from upswing.agents.policy import epsilon_greedy
from upswing.physics import pendulum
from upswing.physics.pendulum import FROM_HANGING, Pendulum
from upswing.runs.simulation import prepare
from upswing.study.architecture import architecture_of
from upswing.study.config import load
from upswing.study.controller import ControllerOptions
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.spec import parse

FINE = {"pendulum": {"accelerations": tuple(float(a) for a in range(-10, 11))}}
SWITCHING = {"pendulum": {"accelerations": (-10.0, 10.0)}}
OTHER = {"pendulum": {"mass": 0.3, "length": 0.5, "friction": 0.004, "time_step": 0.004}}
BODIES = [
    Pendulum(),
    Pendulum(mass=0.3, length=0.5, gravity=3.7, friction=0.004, time_step=0.002),
    Pendulum(orientation=FROM_HANGING),
]


def controller_spec(kind="balancing", learner="fuzzy", task=None, **options):
    options.setdefault("coding", "continuous")
    return beyond_spec(kind, alpha=None, task=task, learner=learner, **options)


def jacobians(body):
    """Of one step of the simulation at φ = 0, by central differences."""
    tiny = 1e-6

    def column(*direction):
        there, back = (
            pendulum.step(body, *(sign * tiny * d for d in direction)) for sign in (1, -1)
        )
        return (np.array(there) - np.array(back)) / (2 * tiny)

    a = np.column_stack([column(1.0, 0.0, 0.0), column(0.0, 1.0, 0.0)])
    return a, column(0.0, 0.0, 1.0)[:, None]


@pytest.mark.parametrize("effort", [1e-5, 1e-3, 1.0])
@pytest.mark.parametrize("body", BODIES)
def test_the_gain_solves_the_riccati_equation_of_the_simulated_pendulum(body, effort):
    a, b = jacobians(body)
    p = solve_discrete_are(a, b, np.diag([1.0, 0.0]), np.array([[effort]]))
    wanted = (b.T @ p @ a) / (effort + b.T @ p @ b)
    np.testing.assert_allclose(energy_lqr.regulator(body, effort), wanted[0], rtol=1e-6)


def test_no_other_gain_costs_less():
    body, effort = Pendulum(), 1e-3
    a, b = jacobians(body)

    def cost(gain):
        total = 0.0
        for start in np.eye(2):
            state = start
            for _ in range(2_000):
                push = -gain @ state
                total += state[0] ** 2 + effort * push**2
                state = a @ state + b[:, 0] * push
        return total

    best = energy_lqr.regulator(body, effort)
    least = cost(best)
    for factor in (0.97, 1.03):
        assert least < cost(best * [factor, 1.0])
        assert least < cost(best * [1.0, factor])


@pytest.mark.parametrize("task", [None, FINE])
def test_the_fuzzy_surface_is_that_of_a_plain_transcription(task):
    spec = controller_spec(task=task, angle_large=20.0, velocity_large=3.0)
    stepped, rng = prepare(spec, 0).learner.stepped, np.random.default_rng(1)
    bilinear = RegularGridInterpolator((stepped.angles, stepped.velocities), stepped.rules)
    for angle, velocity in zip(rng.normal(0, 0.3, 300), rng.normal(0, 2.5, 300), strict=True):
        wanted = controllers.fuzzy(angle, velocity, 20.0, 3.0)
        assert fuzzy.surface(stepped, angle, velocity) == pytest.approx(wanted, abs=1e-12)
        edge = np.clip([angle, velocity], [-np.radians(20), -3], [np.radians(20), 3])
        assert bilinear(edge)[0] == pytest.approx(wanted, abs=1e-12)
        there = np.array(spec.task.pendulum.accelerations)
        q = values(stepped, Point(0, angle, velocity))
        assert there[epsilon_greedy(q, 0.0, False, 0.5)] == there[np.argmin(abs(there - wanted))]


@pytest.mark.parametrize("learner", ["fuzzy", "energy-lqr"])
def test_left_is_to_a_controller_what_right_is(learner):
    stepped = prepare(controller_spec(learner=learner), 0).learner.stepped
    for angle, velocity in np.random.default_rng(2).normal(0, [0.8, 4], (50, 2)):
        one, other = (values(stepped, Point(0, s * angle, s * velocity)) for s in (1, -1))
        np.testing.assert_allclose(one, other[::-1], atol=1e-12)


@pytest.mark.parametrize("body", BODIES)
def test_outside_the_regulators_reach_a_push_brings_the_energy_nearer(body):
    gain = energy_lqr.regulator(body, 1e-3)
    stepped = energy_lqr.EnergyLqr(gain, body, 0.0, 10.0, body.accelerations)
    wanted, rng, moved = pendulum.energy(body, 0.0, 0.0), np.random.default_rng(3), 0
    for angle, velocity in zip(rng.uniform(-3, 3, 200), rng.uniform(-12, 12, 200), strict=True):
        push = energy_lqr.law(stepped, angle, velocity)
        assert energy_lqr.law(stepped, angle + 2 * np.pi, velocity) == pytest.approx(push)
        assert abs(push) <= 10.0
        # What M_C does to the energy in a moment, by the pendulum's own equations.
        with_it, without = (
            pendulum.angular_acceleration(body, angle, velocity, a) * velocity for a in (push, 0.0)
        )
        missing = wanted - pendulum.energy(body, angle, velocity)
        assert (with_it - without) * missing >= 0.0
        moved += with_it != without
    assert moved > 150


@pytest.mark.parametrize("task", [None, SWITCHING, FINE, OTHER], ids=str)
@pytest.mark.parametrize("learner", ["fuzzy", "energy-lqr"])
def test_a_controller_balances(learner, task):
    for seed in range(4):
        trajectory, _ = run(controller_spec("balancing", learner, task), seed)
        assert not trajectory.reset.any()
        assert np.abs(trajectory.angle).max() <= np.radians(20.1)


@pytest.mark.parametrize("task", [None, SWITCHING, FINE, OTHER], ids=str)
def test_energy_and_a_regulator_swing_up_from_everywhere(task):
    spec = controller_spec("full-control", "energy-lqr", task)
    for seed in range(8):
        trajectory, _ = run(spec, seed)
        assert np.abs(trajectory.angle[-1_000:]).max() < np.radians(10)


def test_the_nearest_of_finer_accelerations_stays_nearer_to_upright():
    away = [
        np.sqrt(
            np.mean(run(controller_spec("balancing", "energy-lqr", task))[0].angle[-1_000:] ** 2)
        )
        for task in (None, FINE)
    ]
    assert away[1] < away[0] / 5


@pytest.mark.parametrize("learner", ["fuzzy", "energy-lqr"])
def test_compiled_and_plain_python_are_the_same_to_the_last_bit(learner, tmp_path):
    from tests.unit.runs.test_loop import assert_same_uncompiled

    assert_same_uncompiled(controller_spec("full-control", learner, steps=1_000), tmp_path)


def test_a_controller_has_no_step_size_and_is_told_the_state():
    text = controller_spec().canonical()
    with pytest.raises(BadInput, match="a control has null"):
        parse(text.replace('"alpha":null', '"alpha":0.1'))
    with pytest.raises(
        ValidationError, match="`coding: grid` gives one tile; fuzzy takes the state"
    ):
        architecture_of(learner="fuzzy")
    with pytest.raises(ValidationError, match="fuzzy never acts at random; leave `epsilon` out"):
        architecture_of(learner="fuzzy", coding="continuous", epsilon=0.1)
    with pytest.raises(ValidationError, match="less than or equal to 90"):
        architecture_of(learner="energy-lqr", coding="continuous", catch=100.0)


def test_in_a_study_a_controller_never_acts_at_random():
    cells = Matrix(load(ROOT / "config/beyond.yaml")).cells.values()
    found = [one for one in cells if isinstance(one.architecture, ControllerOptions)]
    assert {one.architecture.learner for one in found} == {"fuzzy", "energy-lqr"}
    assert {(one.epsilon, one.alpha) for one in found} == {(0.0, None)}
