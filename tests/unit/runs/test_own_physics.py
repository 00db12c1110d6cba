"""Another pendulum, other actions and tiles, from the configuration: what physics says must come out."""

import json
from math import pi, radians

import numpy as np
import pytest

from tests.helpers import ARCHITECTURES, make_spec
from tests.oracles import transcription
from upswing.physics import pendulum
from upswing.physics.braking import highest_stoppable_speed
from upswing.physics.environment import State, empty_trajectory, move
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import create
from upswing.runs.evaluation import evaluate
from upswing.runs.simulation import body_of, prepare
from upswing.study.physical import PendulumOptions
from upswing.study.readings import Readings
from upswing.study.spec import Spec
from upswing.study.task import task_named

STEPS = 20_000


def spec_of(kind="full-control", architecture="table", alpha=0.1, steps=STEPS, **task):
    plain = make_spec(kind, architecture, alpha, steps)
    return plain.model_copy(update={"task": task_named(kind, kind=kind, steps=steps, **task)})


def learned(spec, seed=0):
    setting, trajectory = prepare(spec, seed), empty_trajectory(spec.task.steps)
    setting.advance(trajectory, 0, spec.task.steps)
    return setting, trajectory


@pytest.mark.parametrize("architecture", ["table", "modular-table", "networks-5"])
@pytest.mark.parametrize("kind", ["balancing", "full-control"])
def test_a_pendulum_four_times_as_long_moves_half_as_fast(kind, architecture):
    """With lengths × 4, times × 2 and friction to match, eq. 18 to 23 are the same; in binary exactly so."""
    one = learned(spec_of(kind, architecture))[1]
    scaled = spec_of(
        kind, architecture,
        pendulum={"length": 0.8, "time_step": 0.01, "friction": 0.008},
        tiles={"velocity_limit": 10.0},
    )  # fmt: skip
    other = learned(scaled)[1]
    np.testing.assert_array_equal(one.angle, other.angle)
    np.testing.assert_array_equal(one.angular_velocity, 2 * other.angular_velocity)
    np.testing.assert_array_equal(one.action, other.action)
    np.testing.assert_array_equal(one.td_error, other.td_error)
    assert len(np.unique(one.action)) == 3


def test_so_is_the_speed_that_can_be_stopped():
    short = Pendulum()
    long = Pendulum(length=0.8, time_step=0.01, friction=0.008)
    assert highest_stoppable_speed(long) == pytest.approx(
        highest_stoppable_speed(short) / 2, abs=1e-8
    )


def test_a_stronger_push_stops_more():
    speeds = [
        highest_stoppable_speed(Pendulum(accelerations=(-a, 0.0, a)))
        for a in (5.0, 10.0, 20.0, 400.0)
    ]
    assert speeds == sorted(speeds)
    # Without friction and in small steps: ω²/2 = (3/2l)·∫ (a cos − g sin) over a quarter turn or more.
    ideal = Pendulum(friction=0.0, time_step=1e-5, accelerations=(-20.0, 0.0, 20.0))
    angle = np.linspace(-pi / 2, np.arctan(20 / 9.81), 200_001)
    pull = 3 / (2 * 0.2) * (20 * np.cos(angle) - 9.81 * np.sin(angle))
    assert highest_stoppable_speed(ideal) == pytest.approx(
        np.sqrt(2 * np.trapezoid(pull, angle)), rel=1e-3
    )


@pytest.mark.parametrize("architecture", [n for n in ARCHITECTURES if n not in ("idle", "random")])
@pytest.mark.parametrize("pushes", [(-20, 20), (-20, -5, 0, 5, 20)])
def test_any_number_of_actions_is_learned_and_taken(architecture, pushes):
    spec = spec_of(architecture=architecture, pendulum={"accelerations": pushes}, steps=4_000)
    setting, trajectory = learned(spec)
    assert set(trajectory.action) == set(range(len(pushes)))
    after = trajectory.cart_velocity[1:] - trajectory.cart_velocity[:-1]
    np.testing.assert_allclose(
        after,
        0.005 * np.array(pushes)[trajectory.action[:-1]],
        atol=2e-4 * abs(trajectory.cart_velocity).max(),
    )
    values = setting.learner.action_values([setting.encoder and _place(setting)])
    assert values.shape == (1, len(pushes))
    assert 0 <= evaluate(setting, spec, 0).greedy_success_share <= 1


def _place(setting):
    from upswing.agents.features import locate

    return locate(setting.encoder, 0.1, 0.2)


def test_without_a_key_of_ours_the_text_of_a_run_is_what_it_was():
    """Its text decides what is trained anew."""
    for kind in ("balancing", "full-control"):
        task = json.loads(make_spec(kind).canonical())["task"]
        assert task == {"kind": kind, "name": kind, "steps": 2000}
        same = spec_of(
            kind, steps=2000, pendulum={"length": 0.2}, track={}, tiles={"velocity_parts": 20}
        )
        assert same.canonical() == spec_of(kind, steps=2000).canonical()


def test_starts_are_where_the_configuration_says():
    spec = spec_of("full-control", start={"middle": 180, "within": 10, "velocity": 1})
    states = [prepare(spec, seed).state for seed in range(200)]
    off = np.array([(state.angle % (2 * pi)) - pi for state in states])
    assert 0.8 * radians(10) < np.abs(off).max() <= radians(10)
    assert 0.8 < max(abs(state.angular_velocity) for state in states) <= 1


def test_a_shorter_step_is_the_same_time():
    """Lengths that are said in steps of 5 ms are the same time under another time step."""
    spec = spec_of(pendulum={"time_step": 0.001})
    assert spec.task.steps_of(5_000) == 25_000
    idle = spec.model_copy(
        update={"architecture": make_spec(architecture="idle").architecture, "alpha": None}
    )
    setting = prepare(idle, 0)
    # Of 16 starts at rest only that upright stays so, for 20 s and not for 4.
    assert evaluate(setting, idle, 0).greedy_success_share == 1 / 16
    # What swings is the same curve, ever more exactly.
    ends = []
    for dt in (0.02, 0.005, 0.001, 0.0002):
        body, state = Pendulum(time_step=dt), (2.0, 0.0)
        for _ in range(round(1 / dt)):
            state = pendulum.step(body, *state, 0.0)
        ends.append(state[0])
    errors = np.abs(np.array(ends[:-1]) - ends[-1])
    assert errors[0] > 3 * errors[1] > 9 * errors[2]


class TestTrack:
    BODY = Pendulum(friction=0.0)

    def task(self, **track):
        return create("full-control", Readings(), {"track": track})

    def test_the_thesis_s_has_no_end(self):
        state = State(0.0, 0.0, 1e6, 100.0)
        assert move(self.BODY, self.task(), state, 10.0).cart_position > 1e6

    @pytest.mark.parametrize("side", [-1, 1])
    def test_the_cart_stops_dead_at_an_end(self, side):
        after = move(
            self.BODY, self.task(limit=1.0), State(0.5, 0.0, 0.999 * side, 2.0 * side), 0.0
        )
        assert (after.cart_position, after.cart_velocity) == (side * 1.0, 0.0)

    def test_and_jerks_the_rod_as_a_short_and_strong_braking_does(self):
        """Eq. 20 in steps of a nanosecond, with a braking that stops the cart in a microsecond."""
        angle, speed = 0.5, 2.0
        after = move(self.BODY, self.task(limit=1.0), State(angle, 0.0, 0.999, speed), 0.0)
        without = move(self.BODY, self.task(), State(angle, 0.0, 0.999, speed), 0.0)
        fine, state = self.BODY._replace(time_step=1e-9), (without.angle, without.angular_velocity)
        for _ in range(1_000):
            state = pendulum.step(fine, *state, -speed / 1e-6)
        assert after.angular_velocity == pytest.approx(state[1], rel=1e-4)
        assert abs(after.angular_velocity - without.angular_velocity) > 5

    def test_a_run_never_leaves_it(self):
        trajectory = learned(spec_of(track={"limit": 0.5}))[1]
        assert abs(trajectory.cart_position).max() == 0.5
        assert not trajectory.reset.any()

    def test_or_is_reset_there(self):
        trajectory = learned(spec_of(track={"limit": 0.5, "at_end": "falls"}))[1]
        ends = np.flatnonzero(trajectory.reset[:-1]) + 1
        assert len(ends) > 5
        assert (trajectory.cart_position[ends] == 0).all()


@pytest.mark.parametrize("architecture", ["table", "networks-5", "modular-table"])
def test_plain_python_says_the_same_with_five_actions(architecture):
    """The transcription of §3.1.3 knows nothing of tuples and compilers."""
    own = {"length": 0.4, "mass": 0.3, "gravity": 3.7, "accelerations": (-20, -10, 0, 10, 20)}
    spec = spec_of(architecture=architecture, pendulum=own, steps=2_000)
    first = {name: q.copy() for name, q in prepare(spec, 0).learner.learned.items()}
    columns = transcription.transcribe(spec, 0, first)
    trajectory = learned(spec)[1]
    np.testing.assert_array_equal(trajectory.action, columns["action"])
    np.testing.assert_allclose(trajectory.angle, columns["angle"], rtol=2e-5, atol=2e-5)


def test_the_body_of_a_task_is_its_pendulum():
    body = body_of(PendulumOptions(length=0.4, accelerations=(-20, 20)))
    assert (body.length, body.accelerations, body.mass) == (0.4, (-20.0, 20.0), 0.1)
    assert isinstance(spec_of(), Spec)
