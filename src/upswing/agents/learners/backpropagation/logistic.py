"""The logistic function of the hidden neurons."""

from upswing.physics.elementary import exp_of_negative
from upswing.physics.jit import inlined


@inlined
def logistic(x: float) -> float:
    """1 / (1 + e⁻ˣ) (eq. 26), without overflow on either side and without a branch to mispredict."""
    e = exp_of_negative(-abs(x))
    upper = 1.0 / (1.0 + e)
    return upper if x >= 0.0 else e * upper
