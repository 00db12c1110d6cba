"""Learners that hold a policy: their gradients are torch's, their runs those of a plain transcription."""

import numpy as np
import pytest
import torch
from pydantic import ValidationError
from scipy.special import softmax as scipy_softmax
from scipy.stats import truncnorm

from tests.helpers import assert_same, beyond_spec, run
from tests.oracles import policies
from tests.paths import ROOT
from upswing.agents.features import Place, locate
from upswing.agents.learners import choose, state_value, update, values
from upswing.agents.policy import drawn, softmax
from upswing.runs.simulation import prepare
from upswing.study.architecture import architecture_of
from upswing.study.config import load
from upswing.study.controller import ControllerOptions
from upswing.study.matrix import Matrix

FINE = {"pendulum": {"accelerations": tuple(float(a) for a in range(-10, 11))}}
KINDS = ["balancing", "full-control"]
PARTS = {
    "table": {},
    "tiles": {"hidden": (6,)},
    "two layers": {"hidden": (6, 4)},
    "state": {"hidden": (6,), "coding": "continuous"},
}


def actor_spec(kind="full-control", learner="softmax", method="actor-critic", **options):
    options.setdefault("alpha", 0.1)
    task = FINE if learner == "gaussian" else None
    return beyond_spec(kind, epsilon=0.0, task=task, learner=learner, method=method, **options)


def output_of(part, place):
    """A part's outputs at a place, as torch computes them from its own parameters."""
    if not hasattr(part, "networks"):
        return part.oracle[0, place.tiles[0]]
    if part.tiled:
        told = torch.eye(160, dtype=torch.float64)[place.tiles[0]]
    else:
        told = torch.tensor([np.sin(place.angle), np.cos(place.angle), place.angular_velocity / 20])
    return part.networks(0, told[None])[0]


def parameters_of(part):
    if hasattr(part, "networks"):
        return list(part.networks.parameters())
    part.oracle = torch.nn.Parameter(torch.from_numpy(part.learned["q"].copy()))
    return [part.oracle]


def log_probabilities(learner, place):
    out = output_of(learner.actor, place)
    if out.shape == (1,):  # a mean, of 21 accelerations
        accelerations = torch.arange(-10.0, 11.0, dtype=torch.float64)
        out = -0.5 * ((accelerations - 10 * out) / learner.stepped.width) ** 2
    return torch.log_softmax(out, 0)


@pytest.mark.parametrize("biases", ["none", "both"])
@pytest.mark.parametrize("parts", PARTS.values(), ids=PARTS)
@pytest.mark.parametrize("learner", ["softmax", "gaussian"])
def test_an_update_goes_along_the_gradients_of_torch(learner, parts, biases):
    readings = {"biases": biases, "first_q": "random", "initial_weights": 1.0}
    spec = actor_spec(learner=learner, rate=0.3, readings=readings, **parts)
    ours, other = prepare(spec, 1).learner, prepare(spec, 1).learner
    actor, critic = parameters_of(other.actor), parameters_of(other.critic)
    eta = spec.readings.learning_rate if "hidden" in parts else 1.0
    optimiser = torch.optim.SGD([*actor, *critic], lr=eta)
    encoder, rng = prepare(spec, 1).encoder, np.random.default_rng(2)
    for _ in range(40):
        place = locate(encoder, rng.uniform(-3, 3), rng.uniform(-8, 8))
        expected = log_probabilities(other, place)
        shares = softmax(values(ours.stepped, place))
        wanted = expected.detach().numpy()
        np.testing.assert_allclose(shares, np.exp(wanted), rtol=1e-9, atol=1e-300)
        judged = output_of(other.critic, place)[0]
        assert state_value(ours.stepped, place) == pytest.approx(judged.item(), rel=1e-9)
        action, error = int(rng.integers(len(shares))), float(rng.normal())
        update(ours.stepped, place, action, error)
        optimiser.zero_grad()
        (-error * (0.3 * expected[action] + judged)).backward()
        optimiser.step()
    torches = [p.detach().numpy() for p in (*actor, *critic)]
    for name, mine, wanted in zip(ours.learned, ours.learned.values(), torches, strict=True):
        np.testing.assert_allclose(mine, wanted, rtol=1e-8, atol=1e-12, err_msg=name)
    before = prepare(spec, 1).learner.learned
    assert all(np.any(ours.learned[name] != before[name]) for name in before)
    np.testing.assert_allclose(ours.action_values([place])[0], values(ours.stepped, place))


def test_many_accelerations_are_the_gaussian_within_their_range():
    policy = prepare(actor_spec(learner="gaussian", width=3.0), 0).learner
    for middle in (-9.0, -2.5, 0.0, 6.0):
        policy.stepped.actor.q[0, 7, 0] = middle / 10
        shares = np.array(softmax(values(policy.stepped, Place(0, (7,)))))
        ends = ((-10.5 - middle) / 3, (10.5 - middle) / 3)
        wanted = truncnorm(*ends, loc=middle, scale=3)
        np.testing.assert_allclose(np.cumsum(shares), wanted.cdf(np.arange(-9.5, 11)), atol=2e-3)


@pytest.mark.parametrize("preferences", [(0.0, 0.0, 0.0), (1.0, -2.0, 0.5), (800.0, 0.0, 800.0)])
def test_every_action_is_as_frequent_as_its_probability(preferences):
    shares = softmax(preferences)
    np.testing.assert_allclose(shares, scipy_softmax(preferences), rtol=1e-12, atol=1e-300)
    draws = (np.arange(60_000) + 0.5) / 60_000
    counts = np.bincount([drawn(shares, draw) for draw in draws], minlength=3)
    assert counts / len(draws) == pytest.approx(np.array(shares), abs=1e-4)


def test_what_is_no_number_does_not_stop_the_policy():
    assert drawn(softmax((np.nan, 0.0, 0.0)), 0.5) in (0, 1, 2)


@pytest.mark.parametrize("learner", ["softmax", "gaussian"])
def test_a_run_that_is_tried_out_takes_the_likeliest_action(learner):
    setting = prepare(actor_spec(learner=learner), 0)
    stepped, frozen = setting.learner.stepped, setting.rule._replace(step_size=0.0)
    q = tuple(np.random.default_rng(1).normal(size=21 if learner == "gaussian" else 3))
    taken = [choose(stepped, q, frozen, draw) for draw in np.linspace(0, 0.999, 50)]
    assert set(taken) == {int(np.argmax(q))}
    explored = [choose(stepped, q, setting.rule, draw) for draw in np.linspace(0, 0.999, 50)]
    assert len(set(explored)) > 1


@pytest.mark.parametrize("kind", KINDS)
def test_actor_critic_as_in_the_textbook(kind):
    trajectory, learned = run(actor_spec(kind, alpha=0.2, rate=0.1, discount=0.9), 2)
    taken, preferences, v = policies.actor_critic(kind, 2, 3_000, 0.2, 0.1, 0.9)
    assert_as_printed(trajectory, learned, taken, preferences, v)


@pytest.mark.parametrize("kind", KINDS)
def test_reinforce_as_in_the_textbook(kind):
    trajectory, learned = run(actor_spec(kind, "softmax", "reinforce", alpha=0.2, rate=0.02), 2)
    taken, preferences, v = policies.reinforce(kind, 2, 3_000, 0.2, 0.02, 0.7, horizon=39)
    assert_as_printed(trajectory, learned, taken, preferences, v)


def assert_as_printed(trajectory, learned, taken, preferences, v):
    assert trajectory.action.tolist() == taken
    tiles = learned["actor.q"].shape[1]
    np.testing.assert_allclose(learned["actor.q"][0], preferences[:tiles], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(learned["critic.q"][0, :, 0], v[:tiles], rtol=1e-6, atol=1e-9)
    assert np.abs(preferences).max() > 0.1


@pytest.mark.parametrize("method", ["actor-critic", "reinforce"])
@pytest.mark.parametrize("learner", ["softmax", "gaussian"])
def test_a_run_in_pieces_is_the_run_in_one(learner, method):
    spec = actor_spec("balancing", learner, method, rate=0.1, hidden=(5,))
    (whole, learned), (pieces, again) = run(spec), run(spec, pieces=7)
    assert_same(whole, pieces)
    for name in learned:
        np.testing.assert_array_equal(learned[name], again[name])


@pytest.mark.parametrize(
    "options",
    [
        {"method": "reinforce", "coding": "tilings"},
        {"hidden": (5,), "coding": "continuous"},
        {"learner": "gaussian", "hidden": (5,)},
    ],
    ids=str,
)
def test_compiled_and_plain_python_are_the_same_to_the_last_bit(options, tmp_path):
    from tests.unit.runs.test_loop import assert_same_uncompiled

    assert_same_uncompiled(actor_spec(rate=0.1, steps=1_000, **options), tmp_path)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"learner": "softmax"}, "`method: q-learning` improves values of actions; softmax holds"),
        ({"learner": "table", "method": "reinforce"}, "improves a policy; table holds values"),
        ({"learner": "softmax", "method": "reinforce", "epsilon": 0.1}, "leave `epsilon` out"),
        (
            {"learner": "softmax", "method": "reinforce", "coding": "continuous"},
            "a table takes tiles; write `hidden: [30]`",
        ),
        (
            {"learner": "gaussian", "method": "reinforce", "coding": "tilings", "hidden": (5,)},
            "leave `hidden` out",
        ),
    ],
)  # fmt: skip
def test_what_does_not_go_together_is_refused(options, said):
    with pytest.raises(ValidationError, match=said.replace("[", r"\[")):
        architecture_of(**options)


def test_the_random_actions_of_a_study_are_none_of_a_policy():
    cells = Matrix(load(ROOT / "config/beyond.yaml")).cells.values()
    learners = [one for one in cells if not isinstance(one.architecture, ControllerOptions)]
    shares = {(spec.architecture.holds, spec.epsilon) for spec in learners}
    assert shares == {("values", 0.01), ("policy", 0.0)}
