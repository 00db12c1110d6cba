"""What controllers share: a law answers with an acceleration, and the cart has but a few.

The action is the nearest of them. To switch between the two strongest instead, a task has no others
(``accelerations: [-10, 10]``), of which the nearest is then the one on the side of the law's.
"""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.agents.features import Point
from upswing.agents.learners import Array, values
from upswing.agents.policy import Q
from upswing.physics.jit import compiled, with_item


@compiled
def nearness(accelerations: tuple[float, ...], wanted: float) -> Q:
    """How far each acceleration is from the one that is ``wanted`` [m/s²], negative: 0 is there."""
    q = accelerations
    for action in range(len(q)):
        q = with_item(q, action, -abs(accelerations[action] - wanted))
    return q


class ControllerLearner:
    """A controller outside the loop.

    Args:
        stepped: what the loop asks.
        constants: what it is made of, by name, for the file of weights; the arrays of ``stepped``.
    """

    epsilon = 0.0

    def __init__(self, stepped: NamedTuple, constants: Mapping[str, NDArray[Any]]) -> None:
        self.stepped, self.learned = stepped, constants

    def action_values(self, places: Sequence[Point]) -> Array:
        """As the loop has them: how near each acceleration is to what is wanted."""
        return np.array([values(self.stepped, place) for place in places])
