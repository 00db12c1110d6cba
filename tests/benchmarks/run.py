"""``make bench``: ratios of our time to each rival's, measured in turns in one run."""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
from rich.console import Console
from rich.table import Table

from tests.benchmarks.rivals import HIDDEN, in_c, in_numpy, in_torch, ours
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.study.paths import BENCHMARK

REPETITIONS = 9
STEPS, SLOW_STEPS = 1_000_000, 1_500
TARGETS: dict[tuple[str, str], tuple[str, float]] = {
    ("table", "C, float64"): ("at most", 1.1),
    ("networks-5", "C, float32"): ("at most", 0.8),
    ("networks-30", "C, float32"): ("at most", 0.4),
    ("networks-20-5", "C, float32"): ("at most", 0.8),
    ("networks-30", "eager torch"): ("at most", 1 / 1_500),
    ("table", "numpy loop"): ("at most", 1 / 100),
}
"""What is asked of our time as a multiple of the rival's."""


def measure() -> pd.DataFrame:
    """One row for each learner and rival: nanoseconds a step (least and median), and the ratio."""
    rows = []
    for learner, hidden in HIDDEN.items():
        rivals: dict[str, Callable[[int], float | None]] = {}
        reals = ("float", "double") if hidden else ("double",)
        for real in reals:
            name = {"float": "C, float32", "double": "C, float64"}[real]
            rivals[name] = lambda seed, real=real, learner=learner: in_c(learner, STEPS, seed, real)  # type: ignore[misc]
        if hidden:
            rivals["eager torch"] = lambda seed, learner=learner: in_torch(
                learner, SLOW_STEPS, seed
            )  # type: ignore[misc]
        else:
            rivals["numpy loop"] = lambda seed: in_numpy(10 * SLOW_STEPS, seed)
        rivals["ours, modular"] = lambda seed, learner=learner: ours(learner, STEPS, seed, True)  # type: ignore[misc]
        times: dict[str, list[float]] = {name: [] for name in ("ours", *rivals)}
        for seed in range(REPETITIONS):  # in turns, so that a busy machine slows all of them
            times["ours"].append(ours(learner, STEPS, seed))
            for name, rival in rivals.items():
                if (taken := rival(seed)) is not None:
                    times[name].append(taken)
        for name, taken in times.items():
            if not taken:
                continue
            ratios = np.array(times["ours"]) / np.array(taken)
            asked = TARGETS.get((learner, name))
            least = min(times["ours"]) / min(taken)
            rows.append(
                {
                    "learner": learner,
                    "program": name,
                    "least": min(taken),
                    "median": float(np.median(taken)),
                    "ratio": least,  # of the least times
                    "ratio_low": float(np.quantile(ratios, 0.1)),
                    "ratio_high": float(np.quantile(ratios, 0.9)),
                    "target": None if asked is None else asked[1],
                    "met": None if asked is None else bool(least <= asked[1]),
                    "repetitions": REPETITIONS,
                }
            )
    return pd.DataFrame(rows)


def show(frame: pd.DataFrame) -> None:
    """Print the table."""
    table = Table("learner", "program", "ns a step", "ours / it", "spread", "target", title="Speed")
    for row in frame.to_dict("records"):
        asked = (
            "" if pd.isna(row["target"]) else f"≤ {row['target']:.3g} {'✓' if row['met'] else '✗'}"
        )
        table.add_row(
            row["learner"], row["program"], f"{row['least']:,.1f}", f"{row['ratio']:.3g}",
            f"{row['ratio_low']:.3g} … {row['ratio_high']:.3g}", asked,
        )  # fmt: skip
    Console().print(table)


def main() -> int:
    """Measure, print and write the table; the folder of results may be given."""
    results = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("results")
    frame = measure()
    show(frame)
    (results / "tables").mkdir(parents=True, exist_ok=True)
    write_table(results / BENCHMARK, frame)
    seal(results, "benchmark", [results / BENCHMARK])
    return 0


if __name__ == "__main__":
    sys.exit(main())
