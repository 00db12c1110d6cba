"""How numbers and names are written in the page."""

import re
from itertools import groupby
from typing import Any

import numpy as np
import pandas as pd
from markupsafe import Markup

from upswing.study.claim_parts import COUNTED, words_of
from upswing.study.ids import recording_id, run_of
from upswing.study.names import alpha_text

Row = dict[str, Any]

UNKNOWN = "–"


def number(value: float | None, digits: int = 0) -> str:
    """A number with thousands apart, or a dash."""
    known = value is not None and not pd.isna(value) and np.isfinite(value)
    return f"{value:,.{digits}f}".replace("-", "−") if known else UNKNOWN


def percent(value: float | None) -> str:
    """A share in per cent."""
    return UNKNOWN if value is None or pd.isna(value) else f"{100 * value:.1f} %"


def spread(row: Row, measure: str, digits: int = 0, factor: float = 1) -> Markup:
    """The median of a measure, and below it its 5th to 95th percentile over runs."""
    middle, low, high = (
        number(factor * row[f"{measure}_{part}"], digits) for part in ("median", "p05", "p95")
    )
    return Markup('{} <span class="spread">{} to {}</span>').format(middle, low, high)


def interval(row: Row) -> str:
    """An estimate and its interval: ``0.197 [0.158, 0.238]``."""
    return f"{number(row['estimate'], 3)} [{number(row['low'], 3)}, {number(row['high'], 3)}]"


def alpha(value: float | None) -> str:
    """A step size written shortest, or a dash."""
    return UNKNOWN if value is None or pd.isna(value) else alpha_text(value)


def verdict(row: Row) -> str:
    """A verdict as it is shown."""
    return words_of(row["verdict"], row["could_be_better"], row["own"])


def recording(run: str) -> str:
    """The name of a run's recording, from its id or its path."""
    return recording_id(run_of(run))


def capital(text: str) -> str:
    """A text that begins like a sentence."""
    return text[:1].upper() + text[1:]


OF_WHICH = re.compile(r"of (.+), those that (.+)")


def measured(row: Row) -> str:
    """What an estimate is of, as a sentence begins: ``Share of tables that stand at the end``.

    Claims say what is counted, and after a semicolon which part of the claim it is about.
    """
    counted, _, part = str(row["says"] if "says" in row else row["measure"]).partition("; ")
    if str(row["method"]).startswith(("share", "P(X > Y)")):
        of = OF_WHICH.fullmatch(counted)
        counted = f"of {of[1]}, the share of those that {of[2]}" if of else f"share of {counted}"
    return capital(counted) + (f" (“{part}”)" if part else "")


def groups(rows: list[Row], *names: str) -> list[tuple[tuple[Any, ...], list[Row]]]:
    """Rows in their order, parted where one of these columns changes: its values, and its rows."""
    by = groupby(rows, lambda row: tuple(row[name] for name in names))
    return [(values, list(own)) for values, own in by]


def over_readings(row: Row) -> str:
    """How a claim does over readings, in a few words; a dash where they have not been asked."""
    if pd.isna(row["weighted_share"]):
        return UNKNOWN
    return f"{row['grade']} ({number(row['weighted_share'], 2)})"


def unit(row: Row) -> str:
    """What a row of evidence counts: runs, or starts, or problems."""
    return COUNTED.get(str(row["measure"]), "runs")


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
        unit,
        measured,
        capital,
        groups,
    )
}
