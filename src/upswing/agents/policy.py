"""Choosing an action: the ε-greedy policy of §3.1.2, and one that draws by probabilities."""

from typing import NamedTuple

from upswing.physics.elementary import exp_of_negative
from upswing.physics.jit import compiled, inlined, with_item

Q = tuple[float, ...]
"""One value for each action; how many there are is known when the loop is compiled."""


class Rule(NamedTuple):
    """The update rule and the policy."""

    step_size: float  # α
    discount: float  # γ
    bootstrap_sign: float  # −1 under R13 `printed`, else 1
    reward_scale: float  # from rad² into R3's unit
    epsilon: float  # the share of random actions
    random_ties: bool  # R6


@inlined
def explores(draw: float, epsilon: float) -> bool:
    """Whether a ``draw`` from [0, 1) says to explore."""
    return draw < epsilon


@inlined
def explored_action(draw: float, epsilon: float, actions: int) -> int:
    """The random action, of so many, that a ``draw`` below ``epsilon`` says."""
    return min(int(draw / epsilon * actions), actions - 1)


@compiled
def epsilon_greedy(q: Q, epsilon: float, random_ties: bool, draw: float) -> int:
    """The action for values ``q`` by one ``draw`` from [0, 1).

    The one draw decides everything: below ε it says which random action, above it which of several
    equal ones (R6). So every step of every run uses exactly one, and runs of one seed stay paired.
    """
    if explores(draw, epsilon):
        return explored_action(draw, epsilon, len(q))
    best = 0
    equals = 1
    for action in range(1, len(q)):
        if q[action] > q[best]:
            best, equals = action, 1
        elif q[action] == q[best]:
            equals += 1
    if equals == 1 or not random_ties:
        return best
    chosen = int((draw - epsilon) / (1.0 - epsilon) * equals)
    for action in range(best, len(q)):
        if q[action] == q[best]:
            if chosen == 0:
                return action
            chosen -= 1
    return best


@compiled
def softmax(preferences: Q) -> Q:
    """The probability of each action, in proportion to e to the power of its preference."""
    highest = max(preferences)
    shares = preferences
    total = 0.0
    for action in range(len(preferences)):
        share = exp_of_negative(preferences[action] - highest)
        shares = with_item(shares, action, share)
        total += share
    for action in range(len(preferences)):
        shares = with_item(shares, action, shares[action] / total)
    return shares


@compiled
def drawn(shares: Q, draw: float) -> int:
    """The action of a policy with probabilities ``shares`` by one ``draw`` from [0, 1)."""
    last = len(shares) - 1
    for action in range(last):
        draw -= shares[action]
        if draw < 0.0:
            return action
    return last
