"""Our sine, cosine, exponential and logistic function against numpy's and scipy's."""

import os
import subprocess
import sys

import numpy as np
import pytest
from scipy.special import expit

from upswing.agents.learners.backpropagation.logistic import logistic
from upswing.agents.learners.backpropagation.product import product
from upswing.physics.elementary import LOWEST, exp_of_negative, sine_and_cosine

UNIT = np.finfo(float).eps


@pytest.mark.parametrize("largest", [1e-8, np.pi / 4, 4, 1e3, 1e5])
def test_sine_and_cosine_are_right_to_the_last_digit(largest):
    x = np.concatenate(
        [np.random.default_rng(0).uniform(-largest, largest, 20_000), [0.0, largest, -largest]]
    )
    sine, cosine = np.array([sine_and_cosine(value) for value in x]).T
    assert np.abs(sine - np.sin(x)).max() <= UNIT
    assert np.abs(cosine - np.cos(x)).max() <= UNIT


def test_sine_is_odd_and_cosine_even_to_the_bit():
    for x in np.random.default_rng(1).uniform(0, 50, 2_000):
        (sine, cosine), (other_sine, other_cosine) = sine_and_cosine(x), sine_and_cosine(-x)
        assert (sine, cosine) == (-other_sine, other_cosine)


@pytest.mark.parametrize("lowest", [-1e-9, -1, -20, -700])
def test_the_exponential_function_is_right_to_two_units(lowest):
    x = np.append(np.random.default_rng(2).uniform(lowest, 0, 20_000), [0.0, lowest])
    found = np.array([exp_of_negative(value) for value in x])
    assert np.abs(found / np.exp(x) - 1).max() <= 2.5 * UNIT


def test_the_exponential_function_ends_where_numbers_do():
    assert exp_of_negative(-1e300) == exp_of_negative(LOWEST) > 0
    assert exp_of_negative(-np.inf) == exp_of_negative(LOWEST)


def test_the_logistic_function_is_right_to_four_units():
    x = np.append(np.random.default_rng(3).uniform(-700, 700, 20_000), [0.0, -1e9, 1e9, 5, -5])
    found = np.array([logistic(value) for value in x])
    inside = np.abs(x) < 700
    assert np.abs(found[inside] / expit(x[inside]) - 1).max() <= 4 * UNIT
    assert ((found >= 0) & (found <= 1)).all()
    assert np.isnan(logistic(np.nan))


@pytest.mark.parametrize("length", [1, 3, 4, 5, 8, 30])
def test_the_product_is_that_of_numpy(length):
    a, b = np.random.default_rng(length).normal(size=(2, length))
    assert product(a, b) == pytest.approx(a @ b, rel=1e-13, abs=1e-15)


ASK = """
import numpy as np
from upswing.physics.elementary import exp_of_negative, sine_and_cosine
from upswing.agents.learners.backpropagation.product import product
x = np.random.default_rng(4).uniform(-40, 40, 3_000)
print([float(part).hex() for value in x for part in sine_and_cosine(value)])
print([float(exp_of_negative(-abs(value))).hex() for value in x])
print(float(product(x[:30], x[30:60])).hex())
"""


def test_compiled_and_interpreted_are_the_same_bits_and_so_is_a_plainer_processor():
    said = {
        name: subprocess.run(
            [sys.executable, "-c", ASK], env={**os.environ, **environment}, capture_output=True,
            text=True, check=True,
        ).stdout
        for name, environment in {
            "compiled": {},
            "interpreted": {"NUMBA_DISABLE_JIT": "1"},
            # Without the instructions that newer processors have: no fused or wide arithmetic.
            "plain": {"NUMBA_CPU_NAME": "x86-64", "NUMBA_CPU_FEATURES": ""},
        }.items()
    }  # fmt: skip
    assert said["compiled"] == said["interpreted"] == said["plain"]
