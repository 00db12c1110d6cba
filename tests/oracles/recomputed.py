"""The measures of a run and the estimates of a claim once more, from the runs' own Parquet files alone.

Straightforward, and written without the code that made the tables.
"""

import json
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
from scipy.stats import binomtest

from upswing.study.claim_parts import Bound, Part

Row = dict[str, Any]
UNKNOWN = float("nan")


@cache
def run(windows: Path) -> Row:
    """The measures of a run, from its windows, and of its first 5,000 steps from its trajectory."""
    table = pq.read_table(windows)
    w = {name: table[name].to_numpy().astype(float) for name in table.column_names}
    said = json.loads(table.schema.metadata[b"upswing"])["outcome"]
    steps = int(w["steps"].sum())
    late = w["first_step"] >= steps - steps // 5
    end = w["first_step"] >= steps - min(100_000, steps // 5)
    falls = _early_falls(windows)
    below = w["excursions"][late].sum()
    return {
        # Only a look at every step finds the first stable one; the file says it.
        "first_stable_step": _number(said["first_stable_step"]),
        "diverged_at": _number(said["diverged_at"]),
        "greedy_success_share": said["greedy_success_share"],
        "digest": said["digest"],
        "recovered_share": _number(said["recovered_share"]),
        "too_fast_share": w["too_fast"].sum() / w["swing_ups"].sum()
        if w["swing_ups"].any()
        else UNKNOWN,
        "steps": steps,
        "falls": w["falls"].sum(),
        "falls_last_fifth": w["falls"][late].sum(),
        "falls_first_5000": falls,
        "falls_2500_to_5000": _early_falls(windows, 2_500),
        "upright_share": _mean(w, "upright_share", late),
        "above_horizontal_share": _mean(w, "above_horizontal_share", late),
        "mean_reward": _mean(w, "mean_reward", late),
        "upright_at_end": _mean(w, "upright_share", end),
        "swing_ups": w["swing_ups"].sum(),
        "swing_ups_last_fifth": w["swing_ups"][late].sum(),
        "too_fast_last_fifth": w["too_fast"][late].sum(),
        "excursions_last_fifth": below,
        "recovered_last_fifth": w["recovered"][late].sum(),
    }


def cell(results: Path, name: str) -> list[Row]:
    """The measures of all runs of a cell, by their seeds, without those that diverged."""
    files = sorted(
        (results / "runs" / name).glob("seed-*.windows.parquet"),
        key=lambda path: int(path.name.split(".")[0].removeprefix("seed-")),
    )
    return [row for row in map(run, files) if np.isnan(row["diverged_at"])]


def estimate(results: Path, part: Part, cells: tuple[str, ...]) -> tuple[float, ...] | None:
    """The estimate of a part of a claim, and its interval where that is Wilson's; None for what is no run's."""
    runs = [[one for one in cell(results, name) if _all(one, part.among)] for name in cells]
    if part.kind in ("share", "difference_of_shares", "range_of_shares"):
        counted = [(sum(_all(one, part.where) for one in group), len(group)) for group in runs]
        if min(n for _, n in counted) == 0:
            return None
        shares = [k / n for k, n in counted]
        if part.kind == "share":
            wilson = binomtest(*counted[0]).proportion_ci(method="wilson")
            return shares[0], wilson.low, wilson.high
        return (
            shares[0] - shares[1] if part.kind.startswith("diff") else max(shares) - min(shares),
        )
    if part.measure not in (runs[0][0] if runs and runs[0] else {}):
        return None
    x, *others = [np.array([one[part.measure] for one in group]) for group in runs]
    match part.kind:
        case "ratio_of_means":
            return (x.mean() / others[0].mean(),)
        case "ratio_of_sums":
            return (x.sum() / sum(one[str(part.per)] for one in runs[0]),)
        case "difference_of_means" if part.paired:
            return None  # of runs with the same seed
        case "difference_of_means":
            return (x.mean() - others[0].mean(),)
        case "range_of_means":
            means = [y.mean() for y in (x, *others)]
            return (max(means) - min(means),)
        case "probability_greater":
            pairs = x[:, None] - others[0][None, :]
            return (((pairs > 0) + 0.5 * (pairs == 0)).mean(),)
    return None


def _all(row: Row, conditions: dict[str, Bound]) -> bool:
    return all(bound(row[name]) for name, bound in conditions.items())


def _number(value: float | None) -> float:
    return UNKNOWN if value is None else float(value)


def _mean(windows: dict[str, Any], name: str, which: Any) -> float:
    return float(np.average(windows[name][which], weights=windows["steps"][which]))


def _early_falls(windows: Path, first: int = 0, last: int = 5_000) -> int:
    """The falls from step ``first`` up to ``last``, which trajectories keep whole."""
    path = windows.with_name(windows.name.replace(".windows.", ".trajectory."))
    table = pq.read_table(path, columns=["step", "angle", "reset"])
    step, reset = table["step"].to_numpy(), table["reset"].to_numpy()
    tilt = np.abs((table["angle"].to_numpy() + np.pi) % (2 * np.pi) - np.pi)
    over = np.append((tilt[:-1] <= np.pi / 2) & (tilt[1:] > np.pi / 2), False)
    falls = reset | over
    return int(falls[(first <= step) & (step < last)].sum())
