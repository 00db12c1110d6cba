"""Sine, cosine and exponential function in elementary operations: the same bits on every processor.

The C library's differ in their last digit from processor to processor, and one digit is enough to turn
a long run into another. These are sums, products and quotients, each rounded as IEEE 754 says, to about
a unit in the last place; and a processor can do several at once.
"""

# mypy: disable-error-code="no-untyped-call, no-any-return, call-arg"
# ruff: noqa: ARG001

from math import ldexp
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic, overload

from upswing.physics.jit import OPTIONS, inlined

LOG2_E = 1.4426950408889634
LN2_HIGH, LN2_LOW = 6.93147180369123816490e-01, 1.90821492927058770002e-10
"""ln 2 in two parts: a whole number of times the first is exact."""

TWO_OVER_PI = 0.6366197723675814
HALF_PI_HIGH, HALF_PI_MIDDLE, HALF_PI_LOW = (
    1.5707963267341256,
    6.077100506303966e-11,
    2.0222662487959506e-21,
)
"""π/2 in three parts: a whole number of times the first and the second is exact."""

ROUND = 6755399441055744.0
"""1.5 · 2⁵²: adding it rounds to the nearest whole number, which stands in the sum's last bits."""

LOWEST = -708.0
"""Below this, e^x would leave the range of normal numbers."""


@inlined
def sine_and_cosine(x: float) -> tuple[float, float]:
    """Sin x and cos x, for |x| up to some 10⁵ rad.

    x = n π/2 + r with |r| ≤ π/4; power series of r; n says which is which and with which sign.
    """
    n = (x * TWO_OVER_PI + ROUND) - ROUND
    r = ((x - n * HALF_PI_HIGH) - n * HALF_PI_MIDDLE) - n * HALF_PI_LOW
    r2 = r * r
    r4 = r2 * r2
    r8 = r4 * r4
    sine = ((1.0 - r2 / 6) + (1 / 120 - 1 / 5040 * r2) * r4) + (
        (1 / 362880 - 1 / 39916800 * r2) + (1 / 6227020800 - 1 / 1307674368000 * r2) * r4
    ) * r8
    sine *= r
    cosine = ((1.0 - r2 / 2) + (1 / 24 - 1 / 720 * r2) * r4) + (
        (1 / 40320 - 1 / 3628800 * r2)
        + ((1 / 479001600 - 1 / 87178291200 * r2) + 1 / 20922789888000 * r4) * r4
    ) * r8
    quarter = int(n) & 3
    swapped_sine = cosine if quarter & 1 else sine
    swapped_cosine = sine if quarter & 1 else cosine
    return (
        -swapped_sine if quarter & 2 else swapped_sine,
        -swapped_cosine if (quarter + 1) & 2 else swapped_cosine,
    )


@inlined
def exp_of_negative(x: float) -> float:
    """e^x for x ≤ 0; for x below ``LOWEST`` as for ``LOWEST``.

    x = n ln 2 + r with |r| ≤ ln 2 / 2; power series of r; times 2ⁿ.
    """
    x = LOWEST if x < LOWEST else x  # what is not a number stays so
    shifted = x * LOG2_E + ROUND
    n = shifted - ROUND
    r = (x - n * LN2_HIGH) - n * LN2_LOW
    # Σ rᵏ / k! up to k = 13, in pairs of pairs: half as many steps that wait for each other.
    r2 = r * r
    r4 = r2 * r2
    low = (1.0 + r) + (1 / 2 + 1 / 6 * r) * r2
    middle = (1 / 24 + 1 / 120 * r) + (1 / 720 + 1 / 5040 * r) * r2
    high = (1 / 40320 + 1 / 362880 * r) + (1 / 3628800 + 1 / 39916800 * r) * r2
    highest = 1 / 479001600 + 1 / 6227020800 * r
    series = (low + middle * r4) + (high + highest * r4) * (r4 * r4)
    return series * power_of_two(shifted)


def power_of_two(shifted):  # type: ignore[no-untyped-def]  # numba compares the two signatures
    """2ⁿ, where ``shifted`` is n + ``ROUND``."""
    return ldexp(1.0, int(shifted - ROUND)) if shifted == shifted else shifted


@intrinsic
def _power_of_two(_: Any, shifted: Any) -> Any:
    """N stands in the last bits of ``shifted``; it is moved to where a number has its exponent."""

    def generate(_: Any, builder: Any, __: Any, arguments: Any) -> Any:
        word = ir.IntType(64)
        bits = builder.bitcast(arguments[0], word)
        exponent = builder.shl(bits, ir.Constant(word, 52))
        one = ir.Constant(word, 0x3FF0000000000000)
        return builder.bitcast(builder.add(exponent, one), ir.DoubleType())

    return types.float64(types.float64), generate


@overload(power_of_two, jit_options=OPTIONS)
def _compiled_power_of_two(shifted):  # type: ignore[no-untyped-def]
    return lambda shifted: _power_of_two(shifted)
