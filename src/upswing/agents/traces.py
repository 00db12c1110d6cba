"""Eligibility traces over weights (§3.2.2): how much each of them took part in what was done lately.

A trace is a number for each weight, so the traces of a learner are kept in a named tuple of its own
kind. A learner that can be learned by traces gives a body to the first two functions here, and to the
third if it keeps anything that was computed from its weights.
"""

from typing import Any, NamedTuple

import numpy as np

from upswing.agents.learners import Array
from upswing.physics.jit import ByType


def _add_gradient(learner: Any, into: Any, place: Any, action: int, share: float) -> None:
    """Add ``share`` times the gradient of Q(s, a) by the learner's weights to the arrays of ``into``.

    That is a learner of the same kind. The learner itself is meant too: then it is an update.
    """
    raise TypeError(f"{type(learner)} has no gradient")


def _weights(learner: Any) -> tuple[Array, ...]:
    """All arrays of weights, each as a view of shape (weights,)."""
    raise TypeError(f"{type(learner)} has no traces")


def _forget_kept(learner: Any) -> None:
    """Note that the weights were moved from outside."""


_add_gradient_by_type = ByType(_add_gradient)
_weights_by_type = ByType(_weights)
_forget_kept_by_type = ByType(_forget_kept)

add_gradient = _add_gradient_by_type.call
weights = _weights_by_type.call
forget_kept = _forget_kept_by_type.call
add_gradient_of = _add_gradient_by_type.register
weights_of = _weights_by_type.register
forget_kept_of = _forget_kept_by_type.register


def nothing_like(learner: NamedTuple) -> NamedTuple:
    """A learner of the same kind with zeros in all of its own arrays, made outside the loop."""
    fields = {
        name: np.zeros_like(value)
        for name, value in learner._asdict().items()
        if isinstance(value, np.ndarray)
    }
    return learner._replace(**fields)
