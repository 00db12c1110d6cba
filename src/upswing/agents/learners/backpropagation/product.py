"""The scalar product, in four sums that do not wait for each other."""

from upswing.agents.learners import Array
from upswing.physics.jit import inlined


@inlined
def product(a: Array, b: Array) -> float:
    """Σ aⱼ bⱼ over arrays of the same length, always added in the same order."""
    first, second, third, fourth = 0.0, 0.0, 0.0, 0.0
    count = a.shape[0]
    whole = count - count % 4
    for j in range(0, whole, 4):
        first += a[j] * b[j]
        second += a[j + 1] * b[j + 1]
        third += a[j + 2] * b[j + 2]
        fourth += a[j + 3] * b[j + 3]
    for j in range(whole, count):
        first += a[j] * b[j]
    return (first + second) + (third + fourth)
