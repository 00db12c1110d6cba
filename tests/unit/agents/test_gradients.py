"""Linear functions, radial basis functions and traces over weights: whole runs are those of torch's gradients."""

import numpy as np
import pytest
import torch
from pydantic import ValidationError

from tests.helpers import assert_same, beyond_spec, run
from tests.oracles import gradients
from tests.oracles.textbook import World
from upswing.agents import traces
from upswing.agents.features import Place, activate, locate
from upswing.agents.features.continuous import Continuous
from upswing.agents.learners import update, values
from upswing.agents.learners.table import Table
from upswing.physics.environment import State, empty_trajectory
from upswing.physics.jit import compiled
from upswing.runs.simulation import prepare
from upswing.study.architecture import architecture_of

KINDS = ["balancing", "full-control"]
STEPS = 400
FEATURES = {
    "bells": ({"coding": "radial", "width": 0.8}, lambda kind: gradients.bells(kind, 0.8)),
    "circles": ({"coding": "circles", "radius": 1.6}, lambda kind: gradients.circles(kind, 1.6)),
}
LEARNERS = {
    "bells": {"learner": "linear", "coding": "radial", "width": 0.8},
    "circles": {"learner": "linear", "coding": "circles", "radius": 1.6},
    "radial network": {
        "learner": "radial-network", "coding": "continuous", "hidden": (7,), "width": 0.4, "rate": 0.5,
    },
    "networks": {"learner": "networks", "coding": "continuous", "hidden": (7,)},
    "networks on tiles": {"learner": "networks", "hidden": (7,)},
}  # fmt: skip


def torchs(spec, alpha):
    """Q as torch computes it, its parameters with their step sizes, and the same by name."""
    learner, kind = prepare(spec, 2).learner, spec.task.kind
    if spec.architecture.learner == "linear":
        _, of = FEATURES["bells" if spec.architecture.coding == "radial" else "circles"]
        layer = torch.nn.Linear(learner.stepped.encoder.tiles, 3, bias=False, dtype=torch.float64)
        torch.nn.init.zeros_(layer.weight)
        features = of(kind)
        groups = [{"params": [layer.weight], "lr": alpha}]
        named = {"weights": layer.weight}
        return lambda *state: layer(torch.from_numpy(features(*state))), groups, named
    networks = learner.networks
    named = dict(networks.named_parameters())
    if spec.architecture.learner == "networks":
        groups = [{"params": list(named.values()), "lr": alpha * spec.readings.learning_rate}]
        tiles = networks.weights[0].shape[2]
        one_hot, world = torch.eye(tiles, dtype=torch.float64), World(kind, 0)

        def forward(*state):
            told = torch.from_numpy(gradients.inputs(*state))
            if spec.architecture.gives == "tile":
                told = one_hot[world.tile(State(*state, 0.0, 0.0))]
            return networks(0, told[None])[0]

        return forward, groups, named
    inner = [named["centres"], named["inverse_widths"]]
    groups = [
        {"params": inner, "lr": alpha * spec.architecture.rate},
        {"params": [named["weights"]], "lr": alpha},
    ]
    return (
        lambda *state: networks(torch.from_numpy(gradients.inputs(*state))[None])[0],
        groups,
        named,
    )


def assert_as_with_torch(spec, of_torch, alpha):
    forward, groups, named = torchs(spec, alpha)
    before = {name: tensor.detach().clone().numpy() for name, tensor in named.items()}
    taken = of_torch(spec.task.kind, 2, STEPS, forward, groups)
    trajectory, learned = run(spec, 2)
    assert trajectory.action.tolist() == taken
    for name, tensor in named.items():
        wanted = tensor.detach().numpy()
        np.testing.assert_allclose(learned[name], wanted, rtol=1e-6, atol=1e-7, err_msg=name)
        assert np.abs(wanted - before[name]).max() > 1e-3, name


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("options", LEARNERS.values(), ids=LEARNERS)
def test_q_learning_goes_along_the_gradients_of_torch(kind, options):
    spec = beyond_spec(kind, alpha=0.1, steps=STEPS, **options)
    assert_as_with_torch(spec, gradients.q_learning, 0.1)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("name", "biases"),
    [
        *((name, "none") for name in LEARNERS),
        ("networks", "both"),
        ("networks on tiles", "both"),
    ],
)
def test_traces_are_of_the_gradients_of_torch(kind, name, biases):
    options = LEARNERS[name]
    # With larger steps a last digit grows until another action is taken.
    alpha = 0.02 if options["learner"] == "radial-network" else 0.1
    spec = beyond_spec(
        kind, alpha, STEPS, discount=0.9, readings={"biases": biases}, method="sarsa-lambda", trace=0.8,
        **options,
    )  # fmt: skip

    def of_torch(*told):
        return gradients.sarsa_lambda(*told, trace=0.8, discount=0.9)

    assert_as_with_torch(spec, of_torch, alpha)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", FEATURES)
def test_features_are_those_of_whole_arrays_compiled_or_not(kind, name):
    given, of = FEATURES[name]
    encoder, features = prepare(beyond_spec(kind, learner="linear", **given), 0).encoder, of(kind)

    @compiled
    def answer(one, point, into):
        activate(one, point, into)

    rng, limit = np.random.default_rng(0), np.pi if kind == "full-control" else 3.0
    states = [*(rng.uniform(-1, 1, (300, 2)) * (limit, 25)), (-limit, 0.0), (limit - 1e-9, 20.0)]
    for state in states:
        wanted = features(*state)
        for how in (answer, activate):
            told = np.full(encoder.tiles, np.nan)
            how(encoder, locate(encoder, *map(float, state)), told)
            np.testing.assert_allclose(told, wanted, rtol=1e-9, atol=1e-300)
        assert wanted.max() > 0.5  # no state is far from all of them


def test_features_come_round_with_the_angle():
    for given, _ in FEATURES.values():
        encoder = prepare(beyond_spec(learner="linear", **given), 0).encoder
        below, above = np.zeros(encoder.tiles), np.zeros(encoder.tiles)
        activate(encoder, locate(encoder, np.pi - 1e-9, 3.3), below)
        activate(encoder, locate(encoder, -np.pi, 3.3), above)
        np.testing.assert_allclose(below, above, atol=1e-7)


def test_what_is_learned_of_a_state_spreads_to_those_around_it():
    for given, _ in FEATURES.values():
        setting = prepare(beyond_spec(learner="linear", **given), 0)
        learner, encoder = setting.learner, setting.encoder
        update(learner.stepped, locate(encoder, 0.4, 1.0), 1, 1.0)
        here, near, far = (
            values(learner.stepped, locate(encoder, angle, 1.0))[1] for angle in (0.4, 0.9, -2.7)
        )
        assert here > near > abs(far)
        assert values(learner.stepped, locate(encoder, 0.4, 1.0))[0] == 0.0


@pytest.mark.parametrize("options", LEARNERS.values(), ids=LEARNERS)
def test_outside_the_loop_values_are_the_same(options):
    spec = beyond_spec(alpha=0.1, steps=500, **options)
    setting = prepare(spec, 1)
    setting.advance(empty_trajectory(500), 0, 500)
    states = np.random.default_rng(1).uniform(-1, 1, (20, 2)) * (3, 18)
    places = [locate(setting.encoder, *map(float, state)) for state in states]
    inside = [values(setting.learner.stepped, place) for place in places]
    np.testing.assert_allclose(setting.learner.action_values(places), inside, rtol=1e-9, atol=1e-12)
    assert np.ptp(inside) > 0.1


@pytest.mark.parametrize("kind", KINDS)
def test_without_a_trace_it_is_sarsa(kind):
    options = {"learner": "linear", "coding": "radial"}
    one, learned = run(beyond_spec(kind, method="sarsa-lambda", trace=0.0, **options))
    other, as_well = run(beyond_spec(kind, method="sarsa", **options))
    assert_same(one, other)
    np.testing.assert_array_equal(learned["weights"], as_well["weights"])


@pytest.mark.parametrize("options", LEARNERS.values(), ids=LEARNERS)
@pytest.mark.parametrize("method", [{}, {"method": "sarsa-lambda", "trace": 0.7}], ids=str)
def test_a_run_in_pieces_is_the_run_in_one(options, method):
    spec = beyond_spec("balancing", steps=1_000, **options, **method)
    (whole, learned), (pieces, again) = run(spec), run(spec, pieces=7)
    assert_same(whole, pieces)
    for name in learned:
        np.testing.assert_array_equal(learned[name], again[name])


@pytest.mark.parametrize("options", LEARNERS.values(), ids=LEARNERS)
def test_compiled_and_plain_python_are_the_same_to_the_last_bit(options, tmp_path):
    from tests.unit.runs.test_loop import assert_same_uncompiled

    spec = beyond_spec("balancing", steps=200, method="sarsa-lambda", trace=0.7, **options)
    assert_same_uncompiled(spec, tmp_path)


def test_first_centres_lie_among_the_states_and_q_begins_at_zero():
    options = {**LEARNERS["radial network"], "hidden": (500,)}
    learner = prepare(beyond_spec("balancing", **options), 3).learner
    sine, cosine, speed = np.moveaxis(learner.learned["centres"], -1, 0)
    np.testing.assert_allclose(sine**2 + cosine**2, 1)
    assert cosine.min() > -1e-12  # φ within ±90°, as the tiles of balancing are
    assert -1 <= speed.min() < -0.99
    assert 0.99 < speed.max() <= 1
    np.testing.assert_allclose(learner.learned["inverse_widths"], 2.5)
    assert not learner.learned["weights"].any()


def test_with_a_rate_of_0_centres_and_widths_stay():
    spec = beyond_spec(**{**LEARNERS["radial network"], "rate": 0.0}, steps=1_000)
    before, (_, after) = prepare(spec, 0).learner.learned, run(spec)
    for name in ("centres", "inverse_widths"):
        np.testing.assert_array_equal(before[name], after[name])
    assert after["weights"].any()


def test_what_has_no_gradient_or_no_features_says_so():
    table = Table(np.zeros((1, 4, 3)), (0.0,) * 3)
    with pytest.raises(TypeError, match="has no gradient"):
        traces.add_gradient(table, table, Place(0, (1,)), 0, 1.0)
    with pytest.raises(TypeError, match="has no traces"):
        traces.weights(table)
    with pytest.raises(TypeError, match="has no features that are numbers"):
        activate(Continuous(1.0, 20.0), None, np.zeros(3))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"learner": "linear"}, "`coding: grid` gives one tile; linear takes a number for each"),
        ({"learner": "table", "coding": "radial"}, "gives a number for each feature; table takes one"),
        ({"learner": "linear", "coding": "circles", "radius": 0.5}, "greater than or equal to 0.75"),
        ({"learner": "table", "method": "sarsa-lambda", "trace": 0.5}, "write `method: q-lambda`"),
        (
            {"learner": "networks", "hidden": (5, 5), "method": "sarsa-lambda", "trace": 0.5},
            "go with networks of one hidden layer",
        ),
        (
            {"learner": "radial-network", "coding": "continuous", "hidden": (5, 5)},
            "at most 1 item",
        ),
    ],
)  # fmt: skip
def test_what_does_not_go_together_is_refused(options, said):
    with pytest.raises(ValidationError, match=said):
        architecture_of(**options)
