"""Stable-Baselines3's deep Q-network in the study: what it is told and asked, and what it records."""

from copy import deepcopy
from dataclasses import replace

import numpy as np
import pytest
import torch
from torch import nn

from tests.helpers import assert_same, run
from upswing.agents.features import Plan, Point
from upswing.agents.features import create as create_coding
from upswing.agents.learners import Beginning, values
from upswing.agents.learners import create as create_learner
from upswing.agents.learners.backpropagation.dense import inputs
from upswing.agents.policy import Rule
from upswing.physics import tasks
from upswing.physics.environment import State, empty_trajectory, move
from upswing.physics.jit import compiled
from upswing.runs.evaluation import evaluate
from upswing.runs.metrics import UPRIGHT
from upswing.runs.simulation import prepare, streams
from upswing.study.architecture import architecture_named, architecture_of
from upswing.study.readings import Readings
from upswing.study.spec import Spec
from upswing.study.task import task_named

LEARNER = "dqn-sb3"
KINDS = ["balancing", "full-control"]
SEED = 1000
DEFAULTS = architecture_of(learner=LEARNER, coding="continuous", hidden=(1,))
REPEAT = DEFAULTS.action_repeat
RULE = Rule(0.01, 0.99, 1.0, 4.0, 0.1, True)


def spec_of(
    kind="balancing",
    steps=3_000,
    epsilon=0.1,
    alpha=0.001,
    weight=0.0,
    shaping=0.0,
    options=None,
    **readings,
):
    return Spec(
        task=task_named(kind, kind=kind, steps=steps, velocity_weight=weight, shaping=shaping),
        architecture=architecture_named(
            "dqn", learner=LEARNER, coding="continuous", hidden=(64, 64), **(options or {})
        ),
        alpha=alpha,
        seeds=(SEED,),
        epsilon=epsilon,
        discount=0.99,
        readings=Readings(**readings),
    )


def learner_of(hidden, lowest_q=-1000.0, seed=0, **options):
    readings = Readings()
    task = tasks.create("full-control", readings)
    encoder = create_coding("continuous", Plan(task, {}, readings))
    options = {**DEFAULTS.model_dump(), "hidden": hidden, **options}
    return create_learner(
        LEARNER, Beginning(encoder, options, readings, lowest_q, np.random.default_rng(seed))
    )


def known_decisions(learner, count):
    """Fill the library's memory; what is in it, with errors on both sides of the Huber's knee."""
    draws = np.random.default_rng(1)
    known = (
        draws.normal(size=(count, 3)),
        draws.integers(3, size=count),
        -90 * draws.random(count),
        draws.normal(size=(count, 3)),
        draws.random(count) < 0.2,
    )
    for state, action, reward, after, is_terminal in zip(*known, strict=True):
        learner.decision.state[:], learner.decision.next_state[:] = state, after
        learner.decision.sums[:] = reward, 0.99**4
        learner.remember(action, is_terminal)
    return known


def plain(network):
    """The same network of torch's own parts, with twice the digits."""
    return nn.Sequential(*deepcopy(network.q_net)).double()


@pytest.mark.parametrize("hidden", [(64, 64), (7,)])
def test_an_update_is_that_of_the_paper(hidden):
    learner = learner_of(hidden, target_update_interval=2)
    known = known_decisions(learner, 100)
    online = plain(learner.model.q_net)
    target, drawn = deepcopy(online), deepcopy(learner.replay.draws)
    optimiser = torch.optim.Adam(online.parameters(), lr=RULE.step_size, foreach=False)
    unit = DEFAULTS.q_unit * 1000
    knees = set()
    for update in range(1, 6):
        rows = drawn.integers(100, size=64)
        losses, errors = [], []
        for row in rows:
            state, action, reward, after, is_terminal = (column[row] for column in known)
            best = target(torch.from_numpy(after)).max().detach()
            wanted = reward / unit + (0.0 if is_terminal else 0.99**REPEAT) * best
            error = wanted - online(torch.from_numpy(state))[action]
            small = bool(abs(error) < 1)
            losses.append(error**2 / 2 if small else abs(error) - 0.5)
            errors.append(unit * error.item())
            knees.add(small)
        optimiser.zero_grad()
        (sum(losses) / 64).backward()
        optimiser.step()
        np.testing.assert_allclose(learner.update(RULE), errors, rtol=1e-4, atol=1e-2)
        if update % 2 == 0:
            target.load_state_dict(online.state_dict())
        for mine, theirs in (
            (learner.model.q_net, online),
            (learner.model.q_net_target, target),
        ):
            for one, other in zip(mine.parameters(), theirs.parameters(), strict=True):
                np.testing.assert_allclose(one.detach(), other.detach(), rtol=1e-3, atol=1e-4)
    assert knees == {True, False}


@compiled
def compiled_values(net, point):
    return values(net, point)


@pytest.mark.parametrize("hidden", [(64, 64), (7,), (2, 9)])
def test_the_compiled_network_is_the_librarys(hidden):
    learner = learner_of(hidden)
    draws = np.random.default_rng(3)
    points = [Point(0, draws.uniform(-4, 4), draws.uniform(-30, 30)) for _ in range(200)]
    theirs = learner.action_values(points)
    assert np.ptp(theirs) > 0.1
    np.testing.assert_allclose(
        [compiled_values(learner.stepped, point) for point in points], theirs, rtol=1e-4, atol=1e-4
    )
    known_decisions(learner, 64)
    learner.update(RULE)  # they are one memory
    renewed = learner.action_values(points[:1])[0]
    assert not np.allclose(renewed, theirs[0], rtol=1e-3)
    np.testing.assert_allclose(
        compiled_values(learner.stepped, points[0]), renewed, rtol=1e-4, atol=1e-4
    )


def test_what_is_evaluated_is_the_librarys_own_prediction():
    """The oracle asks ``predict`` from each start of the evaluation, and counts for itself."""
    spec = spec_of()
    setting = prepare(spec, SEED)
    setting.advance(empty_trajectory(3_000), 0, 3_000)
    body, task, model = setting.body, setting.task, setting.learner.model
    *_, stream, _ = streams(SEED)
    angles, solved, taken = [], [], set()
    for angle in spec.task.greedy_starts:
        state, decides, falls = State(float(angle), 0.0, 0.0, 0.0), True, 0
        for t in range(spec.task.greedy_steps):
            stream.random()
            angles.append(state.angle)
            if decides or t % REPEAT == 0:
                seen = inputs(Point(0, state.angle, state.angular_velocity))
                action, _ = model.predict(np.array(seen, np.float32), deterministic=True)
                taken.add(int(action))
            state = move(body, task, state, body.accelerations[int(action)])
            decides = tasks.fallen(task, state.angle, state.cart_position)
            if decides:
                state, falls = State(*tasks.start(task, stream), 0.0, 0.0), falls + 1
        solved.append(falls == 0)
    upright = np.mean(np.cos(np.array(angles, np.float32)) >= np.cos(UPRIGHT))
    found = evaluate(setting, spec, SEED)
    assert found == pytest.approx((np.mean(solved), upright), rel=1e-12)
    assert len(taken) > 1
    assert found.greedy_upright_share < 1


def test_the_memory_holds_the_latest_decisions_and_no_others():
    learner = learner_of((2,), lowest_q=-1 / DEFAULTS.q_unit, replay_capacity=10)
    for number in range(1, 36):
        learner.decision.state[:], learner.decision.next_state[:] = number, number + 0.5
        learner.decision.sums[0] = -number
        learner.remember(number % 3, number % 5 == 0)
        drawn = learner.replay.sample(200)
        numbers = drawn.observations[:, 2].numpy().astype(int)
        assert set(numbers) == set(range(max(1, number - 9), number + 1))
        np.testing.assert_array_equal(drawn.actions[:, 0], numbers % 3)
        np.testing.assert_allclose(drawn.rewards[:, 0], -numbers)
        np.testing.assert_allclose(drawn.next_observations[:, 0], numbers + 0.5)
        np.testing.assert_array_equal(drawn.dones[:, 0], numbers % 5 == 0)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("reset", ["fallen", "terminal", "reset"])
def test_it_records_and_remembers_what_the_environment_did(kind, reset):
    spec = spec_of(kind, weight=0.05, shaping=2.0, reset=reset)
    setting, trajectory = prepare(spec, SEED), empty_trajectory(3_000)
    body, task, state, rule = setting.body, setting.task, setting.state, setting.rule
    setting.advance(trajectory, 0, 3_000)
    actions, starts, *_ = streams(SEED)
    tasks.start(task, starts)
    rewards, decided, remembered, due = 0.0, 0, 0, []
    learner = setting.learner
    replay, begun, learned_at = learner.replay, state, 0
    for t in range(3_000):
        actions.random()
        action = trajectory.action[t]
        for name, value in state._asdict().items():
            assert np.float32(value) == getattr(trajectory, name)[t], (name, t)
        if t % REPEAT == 0 or trajectory.reset[t - 1]:
            begun, rewards, decided = state, 0.0, t
        else:
            assert action == trajectory.action[t - 1]
        after = seen = move(body, task, state, body.accelerations[action])
        fell = tasks.fallen(task, after.angle, after.cart_position)
        if fell:
            after = State(*tasks.start(task, starts), 0.0, 0.0)
            seen = after if reset == "reset" else seen
        assert np.float32(-(seen.angle**2)) == trajectory.reward[t]
        assert trajectory.reset[t] == fell
        told = -(seen.angle**2) + tasks.bonus(body, task, 0.99, *state[:2], *seen[:2])
        rewards += 0.99 ** (t - decided) * rule.reward_scale * told
        if fell or (t + 1) % REPEAT == 0:
            for stored, at in ((replay.observations, begun), (replay.next_observations, seen)):
                expected = [np.sin(at.angle), np.cos(at.angle), at.angular_velocity / 20]
                assert stored[remembered, 0] == pytest.approx(expected, rel=1e-6, abs=1e-6)
            assert replay.actions[remembered, 0, 0] == action
            assert replay.rewards[remembered, 0] * learner.unit == pytest.approx(rewards, rel=1e-6)
            assert replay.dones[remembered, 0] == (fell and reset == "terminal")
            remembered += 1
            # It learns at the end of the first decision that reaches a multiple of the interval.
            interval = DEFAULTS.update_interval
            if (t + 1) // interval > learned_at // interval and t + 1 >= DEFAULTS.learning_starts:
                due.append(t)
            learned_at = t + 1
        state = after
    assert replay.pos == remembered
    assert trajectory.reset.any() == (kind == "balancing")
    assert setting.state == state
    # One draw a step, of each stream what the loop would have drawn.
    assert setting.actions.random() == actions.random()
    assert setting.starts.random() == starts.random()
    # δ stands where it learned, and nowhere else.
    assert learner.updates == len(due)
    np.testing.assert_array_equal(np.flatnonzero(np.isfinite(trajectory.td_error)), due)


def test_explores_by_the_one_draw_of_a_step():
    trajectory, _ = run(spec_of("full-control", epsilon=1.0, steps=400), SEED)
    draws = next(streams(SEED)).random(400)
    np.testing.assert_array_equal(
        trajectory.action, np.repeat(np.floor(draws[::REPEAT] * 3), REPEAT)
    )


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("options", [{}, {"action_repeat": 3, "update_interval": 5}])
def test_a_run_in_pieces_is_the_run_in_one(kind, options):
    spec = spec_of(kind, options=options)
    (whole, learned), (pieces, again) = run(spec, SEED), run(spec, SEED, pieces=37)
    assert_same(whole, pieces)
    for name in learned:
        np.testing.assert_array_equal(learned[name], again[name])


def test_the_same_seed_gives_the_same_run_whatever_others_have_drawn():
    one, learned = run(spec_of(), SEED)
    torch.manual_seed(7)
    np.random.seed(7)
    before = torch.get_rng_state()
    other, again = run(spec_of(), SEED)
    assert torch.equal(before, torch.get_rng_state())
    assert_same(one, other)
    for name in learned:
        np.testing.assert_array_equal(learned[name], again[name])
    different, _ = run(spec_of(), SEED + 1)
    assert not np.array_equal(one.action, different.action)
    first, second = learner_of((5,), seed=1).learned, learner_of((5,), seed=2).learned
    assert not np.allclose(first["q_net.0.weight"], second["q_net.0.weight"])


def everything(learner):
    """All that a learner is made of, and the library's agent with it."""
    model, replay = learner.model, learner.replay
    arrays = [*learner.decision, replay.observations, replay.rewards]
    for network in (model.q_net, model.q_net_target):
        arrays += [parameter.detach().numpy() for parameter in network.parameters()]
    for moments in model.policy.optimizer.state_dict()["state"].values():
        arrays += [value.numpy() for value in moments.values()]
    counts = (learner.updates, learner.over_at, replay.pos, replay.draws.bit_generator.state)
    return deepcopy((arrays, counts))


def test_without_a_step_size_nothing_changes_and_learning_goes_on_as_before():
    spec = spec_of()
    setting, trajectory = prepare(spec, SEED), empty_trajectory(3_000)
    setting.advance(trajectory, 0, 1_501)  # in the middle of a decision and between updates
    before = everything(setting.learner)
    evaluate(setting, spec, SEED)
    actions, starts, *_ = streams(5)
    still = setting.rule._replace(step_size=0.0)
    idle = replace(setting, rule=still, actions=actions, starts=starts)
    idle.advance(silent := empty_trajectory(2_000), 0, 2_000)
    assert np.isnan(silent.td_error).all()
    assert (silent.angle != 0).all()
    after = everything(setting.learner)
    assert len(before[0]) > 20
    for one, other in zip(before[0], after[0], strict=True):
        np.testing.assert_array_equal(one, other)
    assert before[1] == after[1]
    setting.advance(trajectory, 1_501, 3_000)
    assert_same(trajectory, run(spec, SEED)[0])


def test_a_run_whose_values_are_not_finite_learns_no_more_and_says_when():
    spec = spec_of("full-control")
    setting, trajectory = prepare(spec, SEED), empty_trajectory(3_000)
    setting.advance(trajectory, 0, 1_600)
    with torch.no_grad():
        setting.learner.model.q_net.q_net[0].bias[0] = np.inf
    setting.advance(trajectory, 1_600, 3_000)
    assert trajectory.diverged_at[0] == 1_607
    assert setting.learner.updates == (1_608 - 1_000) // DEFAULTS.update_interval + 1
    assert np.isnan(trajectory.td_error[1_608:]).all()


def test_it_learns_to_balance():
    trajectory, _ = run(spec_of(steps=20_000, epsilon=0.01), SEED)
    falls = trajectory.reset.reshape(5, -1).sum(axis=1)
    assert falls[0] > 20
    assert falls[-1] <= falls[0] / 10
