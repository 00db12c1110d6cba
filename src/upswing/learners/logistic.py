"""The logistic function of the hidden neurons."""

from math import exp

from upswing.compiled import compiled


@compiled
def logistic(x: float) -> float:
    """1 / (1 + e⁻ˣ) (eq. 26), without overflow on either side and without a branch to mispredict."""
    e = exp(-abs(x))
    upper = 1.0 / (1.0 + e)
    return upper if x >= 0.0 else e * upper
