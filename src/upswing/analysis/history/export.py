"""One table of all entries: a row for each number of a cell, and one for each verdict."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from upswing.analysis.history.entry import Listed
from upswing.analysis.history.read import entries
from upswing.analysis.history.sides import Side, of_entry
from upswing.runs.files.atomic import written
from upswing.runs.files.tables import LOCATIONS, MEASURES
from upswing.study.errors import BadInput
from upswing.study.history_paths import HISTORY

if TYPE_CHECKING:
    import pandas as pd

ENDINGS = (".parquet", ".csv")

COUNTED = (
    "runs", "runs_diverged", "runs_stable", "runs_without_fall_in_last_fifth", "runs_upright",
    "runs_upright_at_end", "runs_kept", "runs_frozen_all", "frozen_success_share",
)  # fmt: skip
"""Columns of a cell without an interval."""


def write_export(results: Path, file: Path) -> tuple[int, int]:
    """Write all entries below ``results`` into a table; how many rows it has, and of how many entries.

    Raises:
        BadInput: the file's ending is another, there is no entry, or one is damaged.
    """
    if file.suffix not in ENDINGS:
        raise BadInput([f"{file}: must end with {' or '.join(ENDINGS)}"])
    every = entries(results)
    if not every:
        raise BadInput([f"{results / HISTORY}: there is no entry to export"])
    frame = exported(results, every)
    with written(file) as beside:
        if file.suffix == ".csv":
            frame.to_csv(beside, index=False)
        else:
            frame.to_parquet(beside, index=False, compression="zstd")
    return len(frame), len(every)


def exported(results: Path, every: list[Listed]) -> "pd.DataFrame":
    """The rows of entries, the oldest first.

    Columns: ``entry``, ``number``, ``when``, ``commit``, ``dirty``, ``notes``; ``what`` (``cell`` or
    ``verdict``) and ``of`` (which one); ``measure`` and ``statistic`` (of a cell: ``falls``, ``mean``;
    of a verdict what is measured, and ``estimate``); ``value``, ``low``, ``high``; ``n`` (number of
    runs); ``verdict``.
    """
    import pandas as pd

    rows = []
    for entry in every:
        head = {
            "entry": entry.id,
            "number": entry.number,
            "when": entry.when,
            "commit": entry.commit,
            "dirty": entry.dirty,
            "notes": "; ".join(entry.every_note),
        }
        side = of_entry(results, entry.id)
        rows += [{**head, **row} for row in (*_of_cells(side), *_of_verdicts(side))]
    columns = (
        "entry", "number", "when", "commit", "dirty", "notes", "what", "of", "measure", "statistic",
        "value", "low", "high", "n", "verdict",
    )  # fmt: skip
    frame = pd.DataFrame(rows, columns=list(columns))
    return frame.astype({"value": float, "low": float, "high": float, "n": "Int64"})


def _of_cells(side: Side) -> list[dict[str, Any]]:
    rows = []
    for row in side.cells.to_dict("records") if side.cells is not None else ():
        head = {"what": "cell", "of": row["cell"], "n": row.get("runs"), "verdict": ""}
        numbers = [
            (measure, statistic, f"{measure}_{statistic}")
            for measure in MEASURES
            for statistic in LOCATIONS
        ]
        numbers += [(column, "value", column) for column in COUNTED]
        for measure, statistic, column in numbers:
            if column in row:
                low, high = row.get(f"{column}_low"), row.get(f"{column}_high")
                values = {"value": row[column], "low": low, "high": high}
                rows.append({**head, "measure": measure, "statistic": statistic, **values})
        if "first_stable_step_median" in row:
            low, high = row["first_stable_step_low"], row["first_stable_step_high"]
            values = {"value": row["first_stable_step_median"], "low": low, "high": high}
            rows.append({**head, "measure": "first_stable_step", "statistic": "median", **values})
    return rows


def _of_verdicts(side: Side) -> list[dict[str, Any]]:
    return [
        {
            "what": "verdict",
            "of": row["claim"],
            "measure": row.get("measure"),
            "statistic": "estimate",
            "value": row.get("estimate"),
            "low": row.get("low"),
            "high": row.get("high"),
            "n": row.get("n"),
            "verdict": row["verdict"],
        }
        for row in side.verdicts.to_dict("records")
    ]
