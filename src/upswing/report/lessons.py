"""What each change beyond the thesis teaches: ``lessons.yaml``, beside what they were written from.

A lesson is words about results. So it is shown only where these came out as they had when it was
written: the verdicts, which ``expected.csv`` keeps, and how many runs of each cell succeeded, which
``changes.csv`` keeps.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from upswing.report import words
from upswing.study.yaml_file import read_yaml

Row = dict[str, Any]

LESSONS, EXPECTED, SUCCEEDED = "lessons.yaml", "expected.csv", "changes.csv"


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


def succeeded_of(changes: Sequence[Row]) -> list[dict[str, str]]:
    """A row for each cell of the chapter's changes: how many of its runs succeed."""
    return [
        {
            "change": change["title"],
            "cell": cell["cell"],
            "succeed": f"{cell['successes']} of {cell['runs']}",
        }
        for change in changes
        for cell in change["cells"]
    ]


def read_told(templates: Path, name: str) -> pd.DataFrame:
    """What came out when the lessons were written: ``EXPECTED`` or ``SUCCEEDED``."""
    return pd.read_csv(templates / name, dtype=str, keep_default_na=False)


def lessons(templates: Path) -> dict[str, str]:
    """The lesson of each change, by its title; none where there is no file of them."""
    path = templates / LESSONS
    return dict(read_yaml(path)["lessons"]) if path.exists() else {}


def teach(changes: Sequence[Row], templates: Path) -> None:
    """Give each change its lesson (``teaches``), empty where it is told of other results."""
    told = lessons(templates)
    then = {
        name: read_told(templates, name).to_dict("records") if told else []
        for name in (EXPECTED, SUCCEEDED)
    }
    for change in changes:
        now = {EXPECTED: expected_of([change]), SUCCEEDED: succeeded_of([change])}
        same = all(
            now[name] == [row for row in rows if row["change"] == change["title"]]
            for name, rows in then.items()
        )
        change["teaches"] = told.get(change["title"], "") if now[EXPECTED] and same else ""
