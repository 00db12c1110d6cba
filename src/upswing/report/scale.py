"""Where an interval and its thresholds lie on a strip, for the small pictures beside a verdict."""

from typing import Any, NamedTuple

import numpy as np

from upswing.analysis.strips import ends


class Strip(NamedTuple):
    """Places on a strip, from 0 at its left to 100 at its right."""

    estimate: float
    low: float
    high: float
    threshold: float
    partly: float
    holds_from: float  # the side on which the claim holds …
    holds_to: float


def strip(row: dict[str, Any]) -> Strip | None:
    """The strip of a row of evidence; None if it has no estimate."""
    values = [row[name] for name in ("estimate", "low", "high", "holds_from", "partly_from")]
    if not all(np.isfinite(values)):
        return None
    left, right = ends(values, str(row["method"]))
    placed = [round(100 * (value - left) / (right - left), 2) for value in values]
    side = (placed[3], 100.0) if row["at_least"] else (0.0, placed[3])
    return Strip(*placed, *side)
