"""How objects show themselves in a notebook: a small table of HTML, escaped."""

from collections.abc import Mapping
from html import escape
from typing import Any

import pandas as pd


def table_of(title: str, rows: Mapping[str, Any]) -> str:
    """A title above two columns."""
    body = "".join(
        f"<tr><td>{escape(name.replace('_', ' '))}</td><td>{escape(brief(value))}</td></tr>"
        for name, value in rows.items()
    )
    return f"<div><b>{escape(title)}</b><table><tbody>{body}</tbody></table></div>"


def brief(value: Any) -> str:
    """A value as a reader wants it: few digits, thousands apart, a dash for none."""
    if isinstance(value, str):
        return value
    if pd.isna(value):
        return "–"
    if float(value).is_integer():
        return f"{int(value):,}"
    return f"{float(value):.4g}"
