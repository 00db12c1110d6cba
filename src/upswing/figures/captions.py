"""Sentences that several captions share."""

ORDERED_BY_FALLS = (
    "The worst, the median and the best run by their number of falls (ties: falls in the last fifth, "
    "seed)"
)
ENSEMBLE = "thin lines are single runs, the thick line their median"
ANGLE_HISTOGRAM = (
    "where the pendulum was: the darker, the more of its steps at that angle at that time; 0° is "
    "upright, ±180° hanging"
)
STANDS = "stands at the end (is upright for 90 % of its last 100,000 steps)"
ORDERED_BY_UPRIGHT = (
    "The worst, the median and the best run by their share of upright steps, |φ| ≤ 20°, in the last "
    "fifth (ties: mean reward, seed)"
)
