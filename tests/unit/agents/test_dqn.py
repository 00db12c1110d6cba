"""The deep Q-network: its update against plain torch, its memory, and what it records."""

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
from upswing.agents.replay import begin, collect, empty_replay, end, sample
from upswing.physics import tasks
from upswing.physics.environment import State, empty_trajectory, move
from upswing.physics.jit import compiled
from upswing.runs.evaluation import evaluate
from upswing.runs.simulation import prepare, streams
from upswing.study.architecture import architecture_named, architecture_of
from upswing.study.readings import Readings
from upswing.study.spec import Spec
from upswing.study.task import task_named

KINDS = ["balancing", "full-control"]
SEED = 1000


def spec_of(
    kind="balancing",
    steps=3_000,
    epsilon=0.1,
    alpha=0.001,
    hidden=(64, 64),
    weight=0.0,
    shaping=0.0,
    **readings,
):
    return Spec(
        task=task_named(kind, kind=kind, steps=steps, velocity_weight=weight, shaping=shaping),
        architecture=architecture_named("dqn", learner="dqn", coding="continuous", hidden=hidden),
        alpha=alpha,
        seeds=(SEED,),
        epsilon=epsilon,
        discount=0.99,
        readings=Readings(**readings),
    )


DEFAULTS = architecture_of(learner="dqn", coding="continuous", hidden=(1,))


def learner_of(hidden, lowest_q=-1000.0, **options):
    readings = Readings()
    task = tasks.create("full-control", readings)
    encoder = create_coding("continuous", Plan(task, {}, readings))
    options = {**DEFAULTS.model_dump(), "hidden": hidden, **options}
    return create_learner(
        "dqn", Beginning(encoder, options, readings, lowest_q, np.random.default_rng(0))
    )


def plain(network):
    """The same network of torch's own parts."""
    layers = []
    for weights, bias in zip(network.weights, network.biases, strict=True):
        linear = nn.Linear(*weights.shape, dtype=torch.float64)
        linear.weight.data, linear.bias.data = weights.data.T.clone(), bias.data.clone()
        layers += [linear, nn.ReLU()]
    return nn.Sequential(*layers[:-1])


def known_decisions(replay, count):
    draws = np.random.default_rng(1)
    replay.states[:count] = draws.normal(size=(count, 3))
    replay.next_states[:count] = draws.normal(size=(count, 3))
    replay.actions[:count] = draws.integers(3, size=count)
    replay.rewards[:count] = -30 * draws.random(count)  # errors on both sides of the Huber's knee
    replay.discounts[:count] = draws.choice([0.0, 0.99, 0.99**4], size=count)
    replay.stored[0] = count


@pytest.mark.parametrize("hidden", [(64, 64), (7,)])
def test_an_update_is_that_of_the_paper(hidden):
    learner = learner_of(hidden, target_update_interval=2)
    known_decisions(learner.replay, 100)
    online, target = plain(learner.network), plain(learner.network)
    optimiser = torch.optim.Adam(online.parameters(), lr=0.01, foreach=False)
    unit = DEFAULTS.q_unit * 1000
    draws = np.random.default_rng(2)
    knees = set()
    for update in range(1, 6):
        rows = draws.integers(100, size=64)
        s, a, r, after, discount = (torch.from_numpy(c[rows]) for c in learner.replay[:5])
        losses, errors = [], []
        for i in range(64):
            wanted = r[i] / unit + discount[i] * target(after[i]).max().detach()
            error = wanted - online(s[i])[a[i]]
            small = bool(abs(error) < 1)
            losses.append(error**2 / 2 if small else abs(error) - 0.5)
            errors.append(unit * error.item())
            knees.add(small)
        optimiser.zero_grad()
        (sum(losses) / 64).backward()
        optimiser.step()
        np.testing.assert_allclose(learner.update(rows, 0.01), errors, rtol=1e-9, atol=1e-9)
        if update % 2 == 0:
            target.load_state_dict(online.state_dict())
        for mine, theirs in zip(learner.network.weights, online[::2], strict=True):
            np.testing.assert_allclose(
                mine.detach().T, theirs.weight.detach(), rtol=1e-7, atol=1e-9
            )
        for mine, theirs in zip(learner.network.biases, online[::2], strict=True):
            np.testing.assert_allclose(mine.detach(), theirs.bias.detach(), rtol=1e-7, atol=1e-9)
    assert knees == {True, False}


@compiled
def compiled_values(net, point):
    return values(net, point)


@pytest.mark.parametrize("hidden", [(64, 64), (7,), (2, 9)])
def test_the_compiled_network_is_torchs(hidden):
    learner = learner_of(hidden)
    draws = np.random.default_rng(3)
    points = [Point(0, draws.uniform(-4, 4), draws.uniform(-30, 30)) for _ in range(200)]
    theirs = learner.action_values(points)
    assert np.ptp(theirs) > 0.1
    np.testing.assert_allclose(
        [compiled_values(learner.stepped, point) for point in points], theirs, rtol=1e-11
    )
    known_decisions(learner.replay, 64)
    learner.update(np.arange(64), 0.01)  # they are one memory
    renewed = learner.action_values(points[:1])[0]
    assert not np.allclose(renewed, theirs[0])
    np.testing.assert_allclose(compiled_values(learner.stepped, points[0]), renewed, rtol=1e-11)


def test_the_memory_holds_the_latest_decisions_and_no_others():
    replay, draws = empty_replay(10), np.random.default_rng(4)
    for number in range(1, 36):
        begin(replay, Point(0, 0.0, float(number)))
        collect(replay, -1.0, 0.5)
        collect(replay, -float(number), 0.5)
        end(replay, number % 3, Point(0, 0.0, number + 0.5), number % 5 == 0)
        rows = sample(replay, 200, draws)
        numbers = np.rint(replay.states[rows, 2] * 20).astype(int)
        assert set(numbers) == set(range(max(1, number - 9), number + 1))
        np.testing.assert_array_equal(replay.actions[rows], numbers % 3)
        np.testing.assert_allclose(replay.rewards[rows], -1.0 - 0.5 * numbers)
        np.testing.assert_allclose(replay.next_states[rows, 2] * 20, numbers + 0.5)
        np.testing.assert_array_equal(replay.discounts[rows], np.where(numbers % 5, 0.25, 0))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("reset", ["fallen", "terminal", "reset"])
def test_it_records_and_remembers_what_the_environment_did(kind, reset):
    spec = spec_of(kind, weight=0.05, shaping=2.0, reset=reset)
    setting, trajectory = prepare(spec, SEED), empty_trajectory(3_000)
    body, task, state, rule = setting.body, setting.task, setting.state, setting.rule
    setting.advance(trajectory, 0, 3_000)
    actions, starts, *_ = streams(SEED)
    tasks.start(task, starts)
    rewards, decided, remembered = 0.0, 0, 0
    replay, begun = setting.learner.replay, state
    for t in range(3_000):
        actions.random()
        action = trajectory.action[t]
        for name, value in state._asdict().items():
            assert np.float32(value) == getattr(trajectory, name)[t], (name, t)
        if t % DEFAULTS.action_repeat == 0 or trajectory.reset[t - 1]:
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
        if fell or (t + 1) % DEFAULTS.action_repeat == 0:
            for stored, at in ((replay.states, begun), (replay.next_states, seen)):
                expected = [np.sin(at.angle), np.cos(at.angle), at.angular_velocity / 20]
                assert stored[remembered] == pytest.approx(expected, abs=1e-12)
            assert replay.actions[remembered] == action
            assert replay.rewards[remembered] == pytest.approx(rewards)
            follows = not (fell and reset == "terminal")
            discount = 0.99 ** (t + 1 - decided) if follows else 0.0
            assert replay.discounts[remembered] == pytest.approx(discount)
            remembered += 1
        state = after
    assert replay.stored[0] == remembered
    assert trajectory.reset.any() == (kind == "balancing")
    assert setting.state == state
    # One draw a step, of each stream what the loop would have drawn.
    assert setting.actions.random() == actions.random()
    assert setting.starts.random() == starts.random()
    # δ stands where it learned, and nowhere else.
    steps = np.arange(1, 3_001)
    learned = (steps % DEFAULTS.update_interval == 0) & (steps >= DEFAULTS.learning_starts)
    np.testing.assert_array_equal(np.isfinite(trajectory.td_error), learned)


def test_explores_by_the_one_draw_of_a_step():
    trajectory, _ = run(spec_of("full-control", epsilon=1.0, steps=400), SEED)
    draws = next(streams(SEED)).random(400)
    expected = np.repeat(np.floor(draws[:: DEFAULTS.action_repeat] * 3), DEFAULTS.action_repeat)
    np.testing.assert_array_equal(trajectory.action, expected)


@pytest.mark.parametrize("kind", KINDS)
def test_a_run_in_pieces_is_the_run_in_one(kind):
    (whole, learned), (pieces, again) = (
        run(spec_of(kind), SEED),
        run(spec_of(kind), SEED, pieces=37),
    )
    assert_same(whole, pieces)
    for name in learned:
        np.testing.assert_array_equal(learned[name], again[name])


def test_the_same_seed_gives_the_same_run_whatever_torch_has_drawn():
    one, learned = run(spec_of(), SEED)
    torch.manual_seed(7)
    before = torch.get_rng_state()
    other, again = run(spec_of(), SEED)
    assert torch.equal(before, torch.get_rng_state())
    assert_same(one, other)
    for name in learned:
        np.testing.assert_array_equal(learned[name], again[name])
    different, _ = run(spec_of(), SEED + 1)
    assert not np.array_equal(one.action, different.action)


def test_without_a_step_size_nothing_changes_and_learning_goes_on_as_before():
    spec = spec_of()
    setting, trajectory = prepare(spec, SEED), empty_trajectory(3_000)
    setting.advance(trajectory, 0, 1_501)  # in the middle of a decision and between updates
    learner = setting.learner
    before = deepcopy((dict(learner.learned), learner.replay, learner.steps, learner.updates))
    evaluate(setting, spec, SEED)
    idle = replace(setting, rule=setting.rule._replace(step_size=0.0), actions=next(streams(5)))
    idle.advance(silent := empty_trajectory(2_000), 0, 2_000)
    assert np.isnan(silent.td_error).all()
    assert (silent.angle != 0).all()
    after = (dict(learner.learned), learner.replay, learner.steps, learner.updates)
    for one, other in zip(before[0].values(), after[0].values(), strict=True):
        np.testing.assert_array_equal(one, other)
    for one, other in zip(before[1], after[1], strict=True):
        np.testing.assert_array_equal(one, other)
    assert before[2:] == after[2:]


def test_it_learns_to_balance():
    trajectory, _ = run(spec_of(steps=20_000, epsilon=0.01), SEED)
    falls = trajectory.reset.reshape(5, -1).sum(axis=1)
    assert falls[0] > 20
    assert falls[-1] <= falls[0] / 10
