"""How a run ended, over endings of several lengths: would another window have said otherwise?

From the windows of a run, a thousandth of it each, so that every ending is a whole number of them. An
excursion below the horizontal counts where it begins, so one that is under way when an ending begins
does not (in the last fifth's ``recovered_share`` it does).
"""

from typing import Any

import numpy as np

from upswing.study.measured import Windows

PERCENT = (5, 10, 20, 30)
"""The endings, in per cent of a run's steps; 20 is the last fifth."""

ENDINGS = {
    "falls_last_fifth": "falls_last_{}",
    "upright_share": "upright_last_{}",
    "upright_at_end": "upright_last_{}",
    "mean_reward": "mean_reward_last_{}",
    "swing_ups_last_fifth": "swing_ups_last_{}",
    "too_fast_last_fifth": "too_fast_last_{}",
    "recovered_share": "recovered_last_{}",
}
"""Each measure of how a run ended, and its name over another ending."""


def endings(windows: Windows) -> dict[str, Any]:
    """The measures of a run over each ending, by name; a share of nothing is None."""
    steps = int(windows.steps.sum())
    found: dict[str, Any] = {}
    for percent in PERCENT:
        last = windows.first_step >= steps - max(steps * percent // 100, 1)
        if not last.any():
            last[-1] = True
        weights = windows.steps[last]
        excursions = int(windows.excursions[last].sum())
        found |= {
            f"falls_last_{percent}": int(windows.falls[last].sum()),
            f"upright_last_{percent}": float(
                np.average(windows.upright_share[last], weights=weights)
            ),
            f"mean_reward_last_{percent}": float(
                np.average(windows.mean_reward[last], weights=weights)
            ),
            f"swing_ups_last_{percent}": int(windows.swing_ups[last].sum()),
            f"too_fast_last_{percent}": int(windows.too_fast[last].sum()),
            f"recovered_last_{percent}": int(windows.recovered[last].sum()) / excursions
            if excursions
            else None,
        }
    return found
