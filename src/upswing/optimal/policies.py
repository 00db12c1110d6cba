"""A policy: what it does in a state, whatever it is made of."""

from typing import Any

from upswing.physics.jit import ByType
from upswing.physics.pendulum import Pendulum


def _act(policy: Any, body: Pendulum, angle: float, angular_velocity: float) -> int:
    """The action, an index into the body's accelerations, at φ [rad] in ±π and φ̇ [rad/s]."""
    raise TypeError(f"{type(policy)} is no policy")


_act_by_type = ByType(_act)

act = _act_by_type.call
act_of = _act_by_type.register
