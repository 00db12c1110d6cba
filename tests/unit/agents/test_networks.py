"""The stepped networks against torch: values against the module, updates against autograd."""

import numpy as np
import pytest
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from upswing.agents.features import Place
from upswing.agents.features.grid import tiles_for
from upswing.agents.learners import Beginning, create, update, values
from upswing.physics import tasks
from upswing.study.readings import Readings

SIZES = [(5,), (30,), (20, 5), (1,), (2, 3)]
BIASES = ["none", "hidden", "both"]


def make(hidden, biases="none", modular=False, learning_rate=0.3, scale=1.0, seed=0):
    readings = Readings(biases=biases, learning_rate=learning_rate, initial_weights=scale)
    tiles = tiles_for(tasks.create("full-control", readings), modular, readings)
    weights = np.random.default_rng(seed)
    return create("networks", Beginning(tiles, {"hidden": hidden}, readings, -1.0, weights)), tiles


def one_hot(tile, tiles):
    return torch.eye(tiles, dtype=torch.float64)[tile : tile + 1]


@pytest.mark.parametrize("modular", [False, True])
@pytest.mark.parametrize("biases", BIASES)
@pytest.mark.parametrize("hidden", SIZES)
def test_updates_are_those_of_autograd(hidden, biases, modular):
    stepped, tiles = make(hidden, biases, modular)
    oracle, _ = make(hidden, biases, modular)
    optimiser = torch.optim.SGD(oracle.networks.parameters(), lr=0.3)
    rng = np.random.default_rng(3)
    for _ in range(60):
        module, tile = int(rng.integers(tiles.modules)), int(rng.integers(6))
        action, target = int(rng.integers(3)), float(rng.normal())
        q = values(stepped.stepped, Place(module, (tile,)))
        expected = oracle.networks(module, one_hot(tile, tiles.tiles))[0]
        np.testing.assert_allclose(q, expected.detach().numpy(), rtol=1e-12, atol=1e-13)
        update(stepped.stepped, Place(module, (tile,)), action, target - q[action])
        # The gradient of ½E² for E = Q − target is what backpropagation of E means.
        optimiser.zero_grad()
        (0.5 * (expected[action] - target) ** 2).backward()
        optimiser.step()
    for name, weights in oracle.networks.state_dict().items():
        np.testing.assert_allclose(stepped.learned[name], weights.numpy(), rtol=1e-10, err_msg=name)


@pytest.mark.parametrize("hidden", [(5,), (20, 5)])
@settings(max_examples=40, deadline=None)
@given(
    biases=st.sampled_from(BIASES),
    visits=st.lists(
        st.tuples(st.integers(0, 1), st.integers(0, 3), st.integers(0, 2), st.booleans()),
        max_size=40,
    ),
)
def test_what_is_kept_is_never_stale(hidden, biases, visits):
    learner, tiles = make(hidden, biases, modular=True)
    for module, tile, action, learns in visits:
        if learns:
            update(learner.stepped, Place(module, (tile,)), action, 1.0)
        fresh = learner.networks(module, one_hot(tile, tiles.tiles))[0].detach().numpy()
        np.testing.assert_allclose(
            values(learner.stepped, Place(module, (tile,))), fresh, rtol=1e-12
        )


def test_the_loop_steps_the_memory_of_torch():
    learner, tiles = make((5,))
    before = learner.networks(0, one_hot(7, tiles.tiles))[0, 1].item()
    update(learner.stepped, Place(0, (7,)), 1, 1.0)
    assert learner.networks(0, one_hot(7, tiles.tiles))[0, 1].item() > before


@pytest.mark.parametrize("scale", [1, 0.5, 0.1])
def test_first_weights_are_uniform_in_their_range(scale):
    learner, _ = make((30,), "both", scale=scale)
    for weights in learner.learned.values():
        assert np.abs(weights).max() <= scale
    first = learner.learned["weights.0"].ravel()
    assert np.abs(first).max() > 0.99 * scale
    assert abs(first.mean()) < 0.02 * scale


def test_initial_weight_scales_share_their_draws():
    whole, half = make((5,), scale=1)[0], make((5,), scale=0.5)[0]
    np.testing.assert_allclose(half.learned["weights.0"], whole.learned["weights.0"] / 2)


@pytest.mark.parametrize(
    ("biases", "names"),
    [
        ("none", {"weights.0", "weights.1"}),
        ("hidden", {"weights.0", "weights.1", "biases.0"}),
        ("both", {"weights.0", "weights.1", "biases.0", "biases.1"}),
    ],
)
def test_biases_are_where_the_reading_puts_them(biases, names):
    assert set(make((5,), biases)[0].learned) == names


def test_huge_potentials_do_not_overflow():
    learner, _ = make((5,))
    learner.learned["weights.0"][:] *= 1e6
    assert np.isfinite(values(learner.stepped, Place(0, (0,)))).all()
