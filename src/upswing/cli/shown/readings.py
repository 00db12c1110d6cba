"""What the claims owe to the readings."""

import pandas as pd

from upswing.cli.terminal import print_table

VERDICTS = ("reproduced", "partly", "inconclusive", "not reproduced")


def print_robustness(robust: pd.DataFrame) -> None:
    """Print a row for each claim: under how many readings it holds, and with which verdicts."""
    counts = ("readings", "holds", "by estimate")
    rows = [
        (
            str(row["claim"]),
            str(row["default"]) or "–",
            *(str(row[name]) for name in ("readings", "holds", "estimate_holds")),
        )
        for row in robust.to_dict("records")
    ]
    words = [
        ", ".join(f"{row[verdict]} {verdict}" for verdict in VERDICTS if row[verdict])
        + f" (sweep {row['sweep']})"
        for row in robust.to_dict("records")
    ]
    header = ("claim", "by default", *counts, "under the readings")
    print_table(header, rows, right=counts, words=words)
