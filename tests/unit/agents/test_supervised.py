"""Networks that a controller taught: lessons as a plain transcription gives them, and what came of them."""

import numpy as np
import pytest
import torch
from pydantic import ValidationError

from tests.helpers import assert_same, beyond_spec, run
from tests.oracles import controllers
from tests.unit.agents.test_controllers import controller_spec
from tests.unit.agents.test_learners import assert_learns_like
from upswing.agents.features import Place, Point
from upswing.agents.learners import supervised, values
from upswing.runs.simulation import prepare
from upswing.study.architecture import architecture_of


def taught_spec(kind="balancing", method="frozen", alpha=None, **options):
    options = {"hidden": (6,), "pairs": 400, "epochs": 8, **options}
    return beyond_spec(
        kind, alpha=alpha, epsilon=0.0, learner="supervised", method=method, **options
    )


@pytest.mark.parametrize("biases", ["none", "both"])
@pytest.mark.parametrize("coding", ["grid", "continuous"])
def test_lessons_are_those_of_a_plain_transcription(coding, biases, monkeypatch):
    spec = taught_spec(
        coding=coding, pairs=60, epochs=3, batch_size=25, readings={"biases": biases}
    )
    seen = {}

    def watched(model, modules, states, wanted, beginning):
        seen["before"] = {name: part.clone() for name, part in model.state_dict().items()}
        seen["states"], seen["wanted"] = states.numpy(), wanted.numpy()
        seen["order"] = list(real(beginning.weights, 60, 25, 3))
        monkeypatch.setattr(supervised, "batches", lambda *_: seen["order"])
        lessons(model, modules, states, wanted, beginning)

    real, lessons = supervised.batches, supervised.taught
    monkeypatch.setattr(supervised, "taught", watched)
    learned = prepare(spec, 0).learner.learned
    w, v = (seen["before"][f"weights.{layer}"].numpy()[0] for layer in (0, 1))
    hidden, outputs = (
        seen["before"][f"biases.{layer}"].numpy()[0] if biases == "both" else np.zeros((3, n))
        for layer, n in ((0, 6), (1, 1))
    )
    pupil = controllers.Pupil(w, hidden, v[:, 0], outputs[:, 0], biases == "both")
    for batch in seen["order"]:
        pupil.learn(seen["states"][batch], seen["wanted"][batch], rate=0.03)
    parts = zip(("weights.0", "weights.1", "biases.0", "biases.1"), pupil.learned, strict=False)
    for name, part in parts:
        np.testing.assert_allclose(
            learned[name][0].reshape(part.shape), part, rtol=1e-7, atol=1e-10
        )
        assert np.abs(learned[name] - seen["before"][name].numpy()).max() > 0.01


def test_every_epoch_has_each_example_once():
    found = list(supervised.batches(np.random.default_rng(0), 25, 10, 3))
    assert [len(batch) for batch in found] == 3 * [10, 10, 5]
    epochs = [np.concatenate(found[first : first + 3]) for first in (0, 3, 6)]
    assert all(sorted(epoch) == list(range(25)) for epoch in epochs)
    assert (epochs[0] != epochs[1]).any()


@pytest.mark.parametrize("teacher", ["fuzzy", "energy-lqr"])
def test_an_example_is_what_the_teacher_does_there(teacher, monkeypatch):
    kept = []
    real = supervised.examples
    monkeypatch.setattr(supervised, "examples", lambda given: kept.append(real(given)) or kept[0])
    prepare(taught_spec("full-control", teacher=teacher), 0)
    ((states, actions),) = kept
    stepped = prepare(controller_spec("full-control", teacher), 0).learner.stepped
    assert actions.tolist() == [int(np.argmax(values(stepped, state))) for state in states]
    assert set(actions.tolist()) == {0, 1, 2}
    spread = np.array([(state.angle, state.angular_velocity) for state in states])
    assert np.abs(spread).max(axis=0) == pytest.approx([np.pi, 20], rel=0.05)
    wanted = supervised.targets(actions, 3, 2.0).numpy()
    assert (wanted.argmax(axis=1) == actions).all()
    assert set(wanted.ravel().tolist()) == {0.0, -2.0}


@pytest.mark.parametrize("coding", ["grid", "continuous"])
def test_q_learning_goes_on_from_the_lessons_along_the_gradients_of_torch(coding):
    spec = taught_spec(method="q-learning", alpha=0.1, coding=coding)
    learner, other = (prepare(spec, 1).learner for _ in range(2))

    def forward(network, place):
        if coding == "grid":
            return network(0, torch.eye(80, dtype=torch.float64)[place.tiles[0]][None])[0]
        told = [np.sin(place.angle), np.cos(place.angle), place.angular_velocity / 20]
        return network(0, torch.tensor([told], dtype=torch.float64))[0]

    def place(rng):
        if coding == "grid":
            return Place(0, (int(rng.integers(6)),))
        return Point(0, rng.uniform(-1, 1), rng.uniform(-5, 5))

    assert_learns_like(learner, other.networks, forward, place)


@pytest.mark.parametrize(
    ("kind", "teacher", "coding"),
    [
        ("balancing", "fuzzy", "continuous"),
        ("full-control", "energy-lqr", "grid"),
    ],
)
def test_a_pupil_does_the_task(kind, teacher, coding):
    spec = taught_spec(kind, teacher=teacher, coding=coding, hidden=(30,), pairs=4_000, epochs=30)
    trajectory, learned = run(spec)
    assert not trajectory.reset.any()
    assert np.abs(trajectory.angle[-1_000:]).max() < np.radians(20)
    assert np.isnan(trajectory.td_error).all()
    fresh = prepare(spec, 0).learner.learned
    assert all(np.array_equal(learned[name], fresh[name]) for name in fresh)  # nothing was learned


@pytest.mark.parametrize("options", [{}, {"modular": True}, {"hidden": (6, 4)}], ids=str)
def test_a_taught_run_is_the_same_again_in_pieces(options):
    spec = taught_spec("full-control", "q-learning", 0.1, **options)
    (whole, learned), (pieces, again) = run(spec), run(spec, pieces=3)
    assert_same(whole, pieces)
    for name in learned:
        np.testing.assert_array_equal(learned[name], again[name])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"teacher": "idle"}, "Input should be 'fuzzy' or 'energy-lqr'"),
        ({"coding": "continuous", "hidden": (5, 5)}, "`hidden` has one size here"),
        ({"coding": "tilings"}, "several tiles at once; supervised takes one tile or the state"),
    ],
)
def test_what_cannot_be_taught_is_refused(options, said):
    with pytest.raises(ValidationError, match=said):
        architecture_of(learner="supervised", **{"hidden": (5,), **options})
