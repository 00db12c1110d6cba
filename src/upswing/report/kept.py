"""Which recordings stand beside the page, and so open from plain files."""

from collections.abc import Iterable
from typing import Any

from upswing.report.words import recording

Row = dict[str, Any]


def kept(tasks: Iterable[str], figures: Iterable[Row], verdicts: Iterable[Row]) -> frozenset[str]:
    """The names of the recordings that the viewer of this page has (``recordings.viewer``).

    They follow from what the page shows, so that the page need not wait for the viewer to be made.

    Args:
        tasks: the tasks of the study's cells.
        figures: every figure with the ``runs`` that it shows.
        verdicts: every verdict with the ``recordings`` of its three runs.
    """
    shown = [recording(run) for figure in figures for run in figure.get("runs", ())]
    of_claims = [row for row in verdicts if len(row["recordings"])]
    return frozenset(
        [
            *(f"task-{task}" for task in tasks),
            *shown,
            *(f"claim-{row['claim']}" for row in of_claims),
            *(recording(path) for row in of_claims for path in row["recordings"]),
        ]
    )
