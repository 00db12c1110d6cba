"""The verdicts as the page shows them, each with its evidence."""

from collections import Counter
from collections.abc import Collection
from pathlib import Path
from typing import Any

import pandas as pd

from upswing.report import words
from upswing.report.readings_shown import rows
from upswing.report.scale import strip
from upswing.runs.files.tables import read_verdicts
from upswing.study.claim_parts import WEAKEST_FIRST, words_of
from upswing.study.errors import BadInput
from upswing.study.paths import EVIDENCE

Row = dict[str, Any]


def judged(results: Path, comparisons: pd.DataFrame, own: bool) -> list[Row]:
    """Each verdict with its evidence, and each comparison with its strip.

    Args:
        results: a folder of results.
        comparisons: its table of evidence.
        own: whether the claims are the study's own and not the thesis's.
    """
    evidence = rows(comparisons)
    verdicts = rows(read_verdicts(results))
    for row in (*evidence, *verdicts):
        row["own"] = own
    for row in evidence:
        row["strip"] = strip(row)
    for verdict in verdicts:
        compared = [row for row in evidence if row["claim"] == verdict["claim"]]
        verdict["evidence"] = compared
        same = [
            row for row in compared
            if (row["cells"], row["threshold"]) == (verdict["cells"], verdict["threshold"])
        ]  # fmt: skip
        if not same:
            raise BadInput(
                [
                    f"{results / EVIDENCE}: {verdict['claim']}: has no row for its verdict; "
                    f"`upswing verdicts {results}` makes both tables"
                ]
            )
        verdict["decisive"] = same[0]
        verdict["unit"] = words.unit(same[0])
        for row in compared:
            row["several"] = sum(other["part"] == row["part"] for other in compared) > 1
            row["many_cells"] = len(str(row["cells"]).split(" : ")) > 1
        verdict["held"] = [
            next(row["says"] for row in compared if row["part"] == part)
            for part in sorted({row["part"] for row in compared})
            if all(row["verdict"] == "reproduced" for row in compared if row["part"] == part)
        ]
        verdict["figure"] = None if pd.isna(verdict["figure"]) else int(verdict["figure"])
    return verdicts


def point_at_own(verdicts: list[Row], shown: list[Row], own: Collection[str]) -> None:
    """Say of each verdict which of the study's own figures show it.

    Args:
        verdicts: they get a key ``shown_in``.
        shown: the figures of the page.
        own: the names of those that the study names itself.
    """
    for verdict in verdicts:
        verdict["shown_in"] = [
            figure
            for figure in shown
            if figure["name"] in own and verdict["claim"] in figure["claims"]
        ]


def counts(verdicts: list[Row]) -> list[tuple[str, list[str]]]:
    """Each verdict that was given, as it is shown, the best first, with its claims."""
    given = Counter(row["verdict"] for row in verdicts)
    own = any(row["own"] for row in verdicts)
    return [
        (words_of(word, False, own), [row["claim"] for row in verdicts if row["verdict"] == word])
        for word in reversed(WEAKEST_FIRST)
        if given[word]
    ]
