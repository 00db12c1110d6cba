"""Sarsa, Q(λ) and Monte Carlo control: against the textbook, and against each other where they must agree."""

import numpy as np
import pytest

from tests.helpers import assert_same, beyond_spec, run
from tests.oracles import textbook
from upswing.agents.returns import NEGLIGIBLE

KINDS = ["balancing", "full-control"]
HORIZON = 39  # 0.7³⁹ is the first power of the discount below a millionth


def ours(spec, seed):
    trajectory, learned = run(spec, seed)
    return trajectory.action.tolist(), learned["q"][0], trajectory


def assert_as_in_the_textbook(spec, seed, expected):
    taken, q, _ = ours(spec, seed)
    expected_taken, expected_q = expected
    assert taken == expected_taken
    np.testing.assert_allclose(q, expected_q[: len(q)], rtol=1e-5, atol=1e-5)
    assert np.abs(q).max() > 0.1


@pytest.mark.parametrize("alpha", [1, 0.1])
@pytest.mark.parametrize("kind", KINDS)
def test_sarsa(kind, alpha):
    spec = beyond_spec(kind, alpha=alpha, method="sarsa")
    assert_as_in_the_textbook(spec, 2, textbook.sarsa(kind, 2, spec.task.steps, alpha))


@pytest.mark.parametrize("trace", [0.0, 0.5, 0.9])
@pytest.mark.parametrize("kind", KINDS)
def test_q_lambda(kind, trace):
    spec = beyond_spec(kind, alpha=0.1, method="q-lambda", trace=trace)
    assert_as_in_the_textbook(spec, 1, textbook.q_lambda(kind, 1, spec.task.steps, 0.1, trace))


@pytest.mark.parametrize("alpha", [1, 0.1])
@pytest.mark.parametrize("kind", KINDS)
def test_monte_carlo(kind, alpha):
    spec = beyond_spec(kind, alpha=alpha, method="monte-carlo")
    expected = textbook.monte_carlo(kind, 3, spec.task.steps, alpha, HORIZON)
    assert_as_in_the_textbook(spec, 3, expected)
    assert 0.7**HORIZON < NEGLIGIBLE < 0.7 ** (HORIZON - 1)


@pytest.mark.parametrize("kind", KINDS)
def test_q_lambda_without_a_trace_is_q_learning(kind):
    one, _ = run(beyond_spec(kind, alpha=0.5, method="q-lambda", trace=0.0))
    other, _ = run(beyond_spec(kind, alpha=0.5))
    assert_same(one, other)


def test_where_the_future_does_not_count_all_methods_agree():
    runs = [
        run(beyond_spec("balancing", alpha=0.5, method=algorithm, discount=0.0, epsilon=1.0, **options))[1]["q"]
        for algorithm, options in (
            ("q-learning", {}), ("sarsa", {}), ("q-lambda", {"trace": 0.9}), ("monte-carlo", {}),
        )
    ]  # fmt: skip
    # Acting at random, all see the same steps. Sarsa learns one step later: its last update is missing.
    np.testing.assert_array_equal(runs[0], runs[2])
    np.testing.assert_array_equal(runs[0], runs[3])
    assert np.count_nonzero(runs[0] != runs[1]) <= 1


@pytest.mark.parametrize("algorithm", ["sarsa", "q-lambda", "monte-carlo"])
@pytest.mark.parametrize("kind", KINDS)
def test_a_run_in_pieces_is_the_run_in_one(kind, algorithm):
    options = {"trace": 0.9} if algorithm == "q-lambda" else {}
    spec = beyond_spec(kind, alpha=0.5, method=algorithm, **options)
    (whole, learned), (pieces, again) = run(spec), run(spec, pieces=7)
    assert_same(whole, pieces)
    np.testing.assert_array_equal(learned["q"], again["q"])


@pytest.mark.parametrize("algorithm", ["sarsa", "monte-carlo"])
def test_an_error_is_recorded_at_the_step_it_belongs_to(algorithm):
    spec = beyond_spec("full-control", alpha=0.5, method=algorithm, steps=300, epsilon=1.0)
    trajectory, _ = run(spec)
    errors = trajectory.td_error
    late = 1 if algorithm == "sarsa" else HORIZON - 1
    assert np.isnan(errors[-late:]).all()
    assert not np.isnan(errors[:-late]).any()
    if algorithm == "monte-carlo":  # the first visit of all: Q was zero
        expected = sum(0.7**n * float(trajectory.reward[n]) for n in range(HORIZON))
        assert errors[0] == pytest.approx(expected, rel=1e-4)
    else:
        assert errors[0] == pytest.approx(float(trajectory.reward[0]), rel=1e-5)
