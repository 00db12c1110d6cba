"""How far a strip reaches that shows intervals against their thresholds, on the page and in figures."""

from collections.abc import Collection

SHARES = ("share", "Kaplan")
"""Methods whose estimates lie between 0 and 1 begin with one of these."""

MARGIN = 0.04
"""What is left free at each end, as a part of what is shown."""


def ends(values: Collection[float], method: str) -> tuple[float, float]:
    """The left and the right end of a strip.

    Args:
        values: what it shows: estimates, both ends of their intervals, thresholds; all finite.
        method: how the estimates were reached; shares are shown from 0 to 1.
    """
    left, right = (0.0, 1.0) if method.startswith(SHARES) else (min(values), max(values))
    margin = MARGIN * (right - left) or 1.0
    return left - margin, right + margin
