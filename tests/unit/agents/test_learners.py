"""Learners beyond the thesis: networks against autograd, decaying step sizes, a control structure that learns."""

import numpy as np
import pytest
import torch

from tests.helpers import beyond_spec, run
from upswing.agents.features import Place, Point
from upswing.agents.features.grid import tiles_for
from upswing.agents.learners import Beginning, create, update, values
from upswing.agents.learners.gated import RATE
from upswing.physics import tasks
from upswing.runs.simulation import prepare
from upswing.study.readings import Readings

BIASES = ["none", "hidden", "both"]


def make(name, seed=0, coding=None, hidden=(), **readings):
    options = {"hidden": hidden, "halved_after": 10.0}
    chosen = Readings(**{"initial_weights": 1.0, **readings})
    encoder = coding or tiles_for(tasks.create("full-control", chosen), False, chosen)
    weights = np.random.default_rng(seed)
    return create(name, Beginning(encoder, options, chosen, -1.0, weights))


def continuous():
    return prepare(beyond_spec(learner="networks", coding="continuous", hidden=(4,)), 0).encoder


def assert_learns_like(learner, oracle, forward, place_of, seed=3):
    """Values and 60 updates of a stepped network are those of torch and its gradients."""
    optimiser = torch.optim.SGD(oracle.parameters(), lr=Readings().learning_rate)
    rng = np.random.default_rng(seed)
    for _ in range(60):
        place = place_of(rng)
        action, target = int(rng.integers(3)), float(rng.normal())
        q, expected = values(learner.stepped, place), forward(oracle, place)
        np.testing.assert_allclose(q, expected.detach().numpy(), rtol=1e-10, atol=1e-12)
        np.testing.assert_allclose(learner.action_values([place])[0], q, rtol=1e-10, atol=1e-12)
        update(learner.stepped, place, action, target - q[action])
        optimiser.zero_grad()
        (0.5 * (expected[action] - target) ** 2).backward()
        optimiser.step()
    for name, weights in oracle.state_dict().items():
        np.testing.assert_allclose(learner.learned[name], weights.numpy(), rtol=1e-9, err_msg=name)


@pytest.mark.parametrize("biases", BIASES)
def test_one_network_with_the_action_as_an_input(biases):
    learner, other = (make("action-input", hidden=(7,), biases=biases) for _ in range(2))

    def forward(network, place):
        return network(0, torch.eye(160, dtype=torch.float64)[place.tiles[0]][None])[0]

    assert_learns_like(
        learner, other.network, forward, lambda rng: Place(0, (int(rng.integers(6)),))
    )


def test_its_actions_share_what_is_learned_of_a_tile():
    learner = make("action-input", hidden=(7,))
    before = values(learner.stepped, Place(0, (3,)))
    update(learner.stepped, Place(0, (3,)), 1, 1.0)
    after = values(learner.stepped, Place(0, (3,)))
    assert all(a != b for a, b in zip(before, after, strict=True))


@pytest.mark.parametrize("biases", BIASES)
def test_networks_on_the_state_itself(biases):
    learner, other = (
        make("networks", coding=continuous(), hidden=(6,), biases=biases) for _ in range(2)
    )

    def forward(networks, point):
        told = [np.sin(point.angle), np.cos(point.angle), point.angular_velocity / 20]
        return networks(0, torch.tensor([told], dtype=torch.float64))[0]

    assert_learns_like(
        learner,
        other.networks,
        forward,
        lambda rng: Point(0, float(rng.uniform(-3, 3)), float(rng.uniform(-20, 20))),
    )


def test_step_sizes_decay_by_the_visits_of_an_entry():
    learner = make("decaying")
    place, other = Place(0, (5,)), Place(0, (6,))
    steps = []
    for _ in range(21):
        before = values(learner.stepped, place)[2]
        update(learner.stepped, place, 2, 1.0)
        steps.append(values(learner.stepped, place)[2] - before)
    np.testing.assert_allclose(steps, 1 / (1 + np.arange(21) / 10))
    assert steps[10] == pytest.approx(0.5)
    update(learner.stepped, other, 2, 1.0)  # another entry has its own
    update(learner.stepped, place, 1, 1.0)
    assert values(learner.stepped, other)[2] == values(learner.stepped, place)[1] == 1.0


def test_with_alpha_1_halved_after_one_update_monte_carlo_averages_its_returns():
    """Acting at random, so that nothing depends on what was learned."""
    spec = beyond_spec(
        "balancing", 1, 400, epsilon=1.0, learner="decaying", halved_after=1.0, method="monte-carlo"
    )
    trajectory, learned = run(spec)
    tiles = tiles_for(tasks.create("balancing", Readings()), False, Readings())
    returns = {}
    reward = 4 * trajectory.reward.astype(float)
    ends = np.flatnonzero(trajectory.reset)
    for t in range(400):
        end = next((e for e in ends if e >= t), 400)
        last = min(end, t + 38)
        if last >= 400:
            continue
        total = sum(0.7**n * reward[t + n] for n in range(last - t + 1))
        (tile,) = _tile(tiles, trajectory, t)
        returns.setdefault((tile, int(trajectory.action[t])), []).append(total)
    assert len(returns) > 20
    for (tile, action), seen in returns.items():
        assert learned["q"][0, tile, action] == pytest.approx(np.mean(seen), rel=1e-4)
        assert learned["updates"][0, tile, action] == len(seen)


def _tile(tiles, trajectory, t):
    from upswing.agents.features import locate

    return locate(tiles, float(trajectory.angle[t]), float(trajectory.angular_velocity[t])).tiles


@pytest.mark.parametrize("hidden", [(), (5,)])
def test_the_control_structure_hands_a_tile_to_the_module_that_was_worth_more(hidden):
    learner = make("gated", hidden=hidden)
    place = Place(0, (9,))

    def module(number):
        return values(learner.stepped.inner, Place(number, place.tiles))

    assert values(learner.stepped, place) == module(0)
    untouched = module(1)
    update(learner.stepped, place, 2, -3.0)
    worth = learner.stepped.worth[9]
    assert worth[0] == pytest.approx(RATE * module(0)[2])
    assert module(1) == untouched
    if worth[0] < 0:  # worse than the other's, which is still its hopeful zero
        assert values(learner.stepped, place) == module(1)
    np.testing.assert_allclose(learner.action_values([place])[0], values(learner.stepped, place))
    assert (learner.stepped.worth[8] == 0).all()


def test_both_modules_come_to_be_used_and_know_different_things():
    _, learned = run(beyond_spec(learner="gated", alpha=0.1, steps=20_000))
    q, used = learned["q"], learned["worth"]
    assert q.shape == (2, 160, 3)
    visited = np.abs(q).sum(axis=2) > 0
    assert (visited.sum(axis=1) > 20).all()
    assert 0 < used.argmax(axis=1).sum() < 160
    assert not np.allclose(q[0], q[1])


def test_a_table_on_overlapping_tilings_moves_by_alpha_in_all():
    spec = beyond_spec(coding="tilings")
    setting = prepare(spec, 0)
    learner = setting.learner
    place = Place(0, tuple(range(8)))
    update(learner.stepped, place, 1, 0.8)
    assert values(learner.stepped, place)[1] == pytest.approx(0.8)
    np.testing.assert_allclose(learner.learned["q"][0, :8, 1], 0.1)
    np.testing.assert_allclose(learner.action_values([place])[0], values(learner.stepped, place))


@pytest.mark.parametrize(
    "options",
    [
        {"coding": "tilings"},
        {"coding": "hashed", "cuts": 4, "entries": 160, "method": "sarsa"},
        {"learner": "gated", "method": "q-lambda", "trace": 0.5},
        {"learner": "gated", "hidden": (5,)},
        {"learner": "decaying", "halved_after": 9.0, "coding": "fine", "cuts": 2},
        {"learner": "action-input", "hidden": (5,)},
        {"learner": "networks", "hidden": (5,), "coding": "continuous", "method": "monte-carlo"},
    ],
    ids=str,
)
def test_compiled_and_plain_python_are_the_same_to_the_last_bit(options, tmp_path):
    from tests.unit.runs.test_loop import assert_same_uncompiled

    assert_same_uncompiled(beyond_spec(alpha=0.5, steps=1_000, **options), tmp_path)
