"""What each change beyond the thesis teaches: ``lessons.yaml``, beside what they were written from.

A lesson is words about results. So it is shown only where these came out as they had when it was
written, which ``expected.csv`` keeps.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from upswing.report import words
from upswing.study.yaml_file import read_yaml

Row = dict[str, Any]

LESSONS, EXPECTED = "lessons.yaml", "expected.csv"


def expected_of(changes: Sequence[Row]) -> list[dict[str, str]]:
    """A row for each claim of the chapter's changes (``chapter.changes``), all of it text."""
    return [
        {
            "change": change["title"],
            "what was expected": f"{claim['claim']}: {claim['statement']}",
            "verdict": words.verdict(claim),
            "measured, the weakest part": claim["measure"],
            "estimate [95 %]": words.interval(claim),
            "threshold": claim["threshold"],
            "n": str(claim["n"]),
        }
        for change in changes
        for claim in change["expected"]
    ]


def read_expected(templates: Path) -> pd.DataFrame:
    """What came out of each expectation when the lessons were written."""
    return pd.read_csv(templates / EXPECTED, dtype=str, keep_default_na=False)


def lessons(templates: Path) -> dict[str, str]:
    """The lesson of each change, by its title; none where there is no file of them."""
    path = templates / LESSONS
    return dict(read_yaml(path)["lessons"]) if path.exists() else {}


def teach(changes: Sequence[Row], templates: Path) -> None:
    """Give each change its lesson (``teaches``), empty where it is told of other results."""
    told = lessons(templates)
    then = read_expected(templates).to_dict("records") if told else []
    for change in changes:
        now = expected_of([change])
        same = now == [row for row in then if row["change"] == change["title"]]
        change["teaches"] = told.get(change["title"], "") if now and same else ""
