"""How numbers and names are written in the page."""

from typing import Any

import numpy as np
import pandas as pd

from upswing.study.claim_parts import words_of
from upswing.study.ids import recording_id, run_of
from upswing.study.names import alpha_text

UNKNOWN = "–"


def number(value: float | None, digits: int = 0) -> str:
    """A number with thousands apart, or a dash."""
    known = value is not None and not pd.isna(value) and np.isfinite(value)
    return f"{value:,.{digits}f}".replace("-", "−") if known else UNKNOWN


def percent(value: float | None) -> str:
    """A share in per cent."""
    return UNKNOWN if value is None or pd.isna(value) else f"{100 * value:.1f} %"


def spread(row: dict[str, Any], measure: str, digits: int = 0, factor: float = 1) -> str:
    """The median of a measure, and its 5th to 95th percentile over runs."""
    middle, low, high = (
        number(factor * row[f"{measure}_{part}"], digits) for part in ("median", "p05", "p95")
    )
    return f"{middle} ({low} … {high})"


def interval(row: dict[str, Any]) -> str:
    """An estimate and its interval: ``0.197 [0.158, 0.238]``."""
    return f"{number(row['estimate'], 3)} [{number(row['low'], 3)}, {number(row['high'], 3)}]"


def alpha(value: float | None) -> str:
    """A step size written shortest, or a dash."""
    return UNKNOWN if value is None or pd.isna(value) else alpha_text(value)


def verdict(row: dict[str, Any]) -> str:
    """A verdict as it is shown."""
    return words_of(row["verdict"], row["could_be_better"])


def recording(run: str) -> str:
    """The name of a run's recording, from its id or its path."""
    return recording_id(run_of(run))


def over_readings(row: dict[str, Any]) -> str:
    """How a claim does over readings, in a few words; a dash where they have not been asked."""
    if pd.isna(row["weighted_share"]):
        return UNKNOWN
    return f"{row['grade']} ({number(row['weighted_share'], 2)})"


FILTERS = {
    function.__name__: function
    for function in (
        number,
        percent,
        spread,
        interval,
        alpha,
        verdict,
        recording,
        over_readings,
    )
}
