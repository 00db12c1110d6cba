"""What a change teaches is told of the results that it was written from, and of no others."""

from copy import deepcopy

import pandas as pd
import pytest

from upswing.report.lessons import EXPECTED, LESSONS, SUCCEEDED, expected_of, succeeded_of, teach

CLAIM = {
    "claim": "B1", "statement": "It stands.", "verdict": "reproduced", "could_be_better": False, "own": True,
    "measure": "runs that stand", "estimate": 0.9, "low": 0.74, "high": 0.97, "threshold": "≥ 0.5", "n": 30,
}  # fmt: skip
CELLS = [
    {"cell": f"a/b/alpha-{alpha}", "successes": number, "runs": 30}
    for alpha, number in ((1, 0), (0.1, 27))
]
CHANGES = [
    {"title": "Other tiles", "cells": CELLS, "expected": [CLAIM]},
    {"title": "Nothing expected", "cells": CELLS, "expected": []},
]  # fmt: skip


@pytest.fixture
def templates(tmp_path):
    """A folder with lessons, and with what they were written from."""
    text = "lessons: {Other tiles: They help., Nothing expected: It is not told.}"
    (tmp_path / LESSONS).write_text(text, "utf-8")
    pd.DataFrame(expected_of(CHANGES)).to_csv(tmp_path / EXPECTED, index=False)
    pd.DataFrame(succeeded_of(CHANGES)).to_csv(tmp_path / SUCCEEDED, index=False)
    return tmp_path


def taught(templates, edit=lambda _: None):
    changes = deepcopy(CHANGES)
    edit(changes[0])
    teach(changes, templates)
    return [change["teaches"] for change in changes]


def test_a_lesson_is_told_of_its_own_results(templates):
    assert taught(templates) == ["They help.", ""]


@pytest.mark.parametrize(
    "edit",
    [
        lambda change: change["expected"][0].update(verdict="partly"),
        lambda change: change["expected"][0].update(estimate=0.8),
        lambda change: change["expected"][0].update(estimate=float("nan")),
        lambda change: change["expected"].clear(),
        lambda change: change["cells"][0].update(successes=1),  # a cell that no claim looks at
        lambda change: change["cells"][1].update(runs=29),
        lambda change: change["cells"].pop(),
    ],
)
def test_and_of_no_others(edit, templates):
    assert taught(templates, edit) == ["", ""]


def test_without_lessons_nothing_is_told(tmp_path):
    assert taught(tmp_path) == ["", ""]
