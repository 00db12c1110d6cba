"""The verdicts on seeds that had been looked at before: an exploratory column beside those that count.

``make exploratory`` judges the claims on the seeds 0 to 29; what comes out is kept among the templates.
"""

from pathlib import Path
from typing import Any

import pandas as pd

from upswing.report import words
from upswing.runs.files.atomic import written
from upswing.runs.files.tables import read_verdicts
from upswing.runs.study_file import read_study

TABLE = "exploratory.csv"
COLUMNS = ("claim", "verdict", "estimate", "n", "seeds")

Row = dict[str, Any]


def write_exploratory(results: Path, templates: Path) -> Path:
    """Keep the verdicts of ``results`` among the templates; returns the table's path."""
    seeds = read_study(results).seeds
    rows = [
        {
            "claim": row["claim"],
            "verdict": words.verdict({**{str(k): v for k, v in row.items()}, "own": False}),
            "estimate": words.interval({str(k): v for k, v in row.items()}),
            "n": row["n"],
            "seeds": f"{min(seeds)} to {max(seeds)}",
        }
        for row in read_verdicts(results).to_dict("records")
    ]
    path = templates / TABLE
    with written(path) as beside:
        pd.DataFrame(rows, columns=list(COLUMNS)).to_csv(beside, index=False)
    return path


def exploratory(templates: Path) -> dict[str, Row]:
    """What was kept, by claim; nothing where nothing was."""
    path = templates / TABLE
    if not path.exists():
        return {}
    frame = pd.read_csv(path, dtype=str, keep_default_na=False)
    rows = [{str(k): v for k, v in row.items()} for row in frame.to_dict("records")]
    return {str(row["claim"]): row for row in rows}
