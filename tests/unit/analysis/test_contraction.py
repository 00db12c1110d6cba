"""C16: on a finite deterministic MDP with α = 1, each full interval shrinks the largest error by γ."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from upswing.agents.features import Place
from upswing.agents.learners import update, values
from upswing.agents.learners.table import Table


def value_iteration(following, rewards, discount):
    """Q* (states, actions) of a deterministic MDP."""
    q = np.zeros(rewards.shape)
    for _ in range(5_000):
        q = rewards + discount * q.max(axis=1)[following]
    return q


@settings(max_examples=50, deadline=None)
@given(
    st.integers(2, 12),
    st.sampled_from([0.0, 0.3, 0.7, 0.95]),
    st.integers(0, 2**32 - 1),
)
def test_the_largest_error_shrinks_by_the_discount_in_every_full_interval(states, discount, seed):
    rng = np.random.default_rng(seed)
    following = rng.integers(states, size=(states, 3))
    rewards = rng.normal(size=(states, 3))
    best = value_iteration(following, rewards, discount)
    table = Table(rng.normal(size=(1, states, 3)), (0.0, 0.0, 0.0))
    error = np.abs(table.q[0] - best).max()
    for _ in range(30):
        for visit in rng.permutation(states * 3):  # a full interval, in any order
            state, action = divmod(int(visit), 3)
            target = rewards[state, action] + discount * max(
                values(table, Place(0, (following[state, action],)))
            )
            update(table, Place(0, (state,)), action, target - table.q[0, state, action])
        now = np.abs(table.q[0] - best).max()
        assert now <= discount * error + 1e-12
        error = now
    assert error <= max(discount**30 * 100, 1e-9)


def test_a_single_update_is_equation_12():
    table = Table(np.array([[[1.0, 2.0, 3.0], [5.0, 4.0, 0.0]]]), (0.0, 0.0, 0.0))
    step_size, reward, discount = 0.25, -1.0, 0.7
    td_error = reward + discount * max(values(table, Place(0, (1,)))) - table.q[0, 0, 1]
    update(table, Place(0, (0,)), 1, step_size * td_error)
    assert table.q[0, 0, 1] == pytest.approx(2.0 + 0.25 * (-1.0 + 0.7 * 5.0 - 2.0))
    assert table.q[0, 0, 0] == 1.0
