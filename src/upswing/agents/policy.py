"""Choosing an action: the ε-greedy policy of §3.1.2."""

from typing import NamedTuple

from upswing.physics.jit import compiled, inlined

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
