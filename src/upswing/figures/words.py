"""Sentences that several captions share."""

MEDIAN_BY_FALLS = (
    "The run shown is the median one by its number of falls (ties: falls in the last fifth, seed)"
)
MEDIAN_BY_UPRIGHT = (
    "The run shown is the median one by its share of upright steps, |φ| ≤ 20°, in the last fifth "
    "(ties: mean reward, seed)"
)
CROWD = "thin lines are single runs, the thick line their median"
