"""The shortest training after which full control is solved every time, by a rule, on seeds of its own.

Every candidate learns once for each seed, for the longest of the lengths. What it came to after a
shorter training is in the same run, because nothing in it depends on how long it will go on. A length
is *reliable* if after it, and after every longer one, all seeds were upright for ``EVERY_TIME`` of the
last fifth. Of each group the candidate with the shortest reliable length is chosen; of equals the first.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from upswing.analysis.ablation import EVERY_TIME
from upswing.physics.environment import Trajectory, empty_trajectory
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.runs.metrics import UPRIGHT, last_fifth
from upswing.runs.simulation import prepare
from upswing.study.config import Search, Study
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.paths import CHOSEN, SHORTEST
from upswing.study.spec import Spec

KEPT = ("title", "architecture", "alpha", "discount", "seeds")


def write_shortest(study: Study, results: Path) -> pd.DataFrame:
    """Try every candidate of the study; writes all that was tried, and returns what was chosen."""
    if study.search is None:
        raise BadInput(["study: search: missing; there is nothing to search"])
    tried = pd.DataFrame(
        [row for group in range(len(study.search.candidates)) for row in _tried(study, group)]
    )
    write_table(results / SHORTEST, tried)
    best = chosen(tried)
    write_table(results / CHOSEN, best)
    seal(results, "shortest", [results / SHORTEST, results / CHOSEN])
    return best


def _tried(study: Study, group: int) -> list[dict[str, object]]:
    search = study.search
    assert search is not None  # noqa: S101  asked before
    candidates = search.candidates[group]
    trajectory = empty_trajectory(max(search.lengths))
    rows: list[dict[str, object]] = []
    for name in candidates.architectures:
        for alpha in candidates.alphas:
            spec = Matrix(study).spec(search.task, name, alpha, search.seeds)
            shares = upright_shares(spec, search, trajectory)
            for length, after in zip(search.lengths, shares.T, strict=True):
                rows.append(
                    {
                        "group": group,
                        "title": candidates.title,
                        "architecture": name,
                        "alpha": alpha,
                        "discount": spec.discount,
                        "steps": length,
                        "seeds": len(after),
                        "sure": int((after >= EVERY_TIME).sum()),
                        "worst": float(after.min()),
                    }
                )
            sure = [row["sure"] for row in rows[-len(search.lengths) :]]
            print(f"{candidates.title}: {name}, α = {alpha:g}: {sure}", flush=True)
    return rows


def upright_shares(spec: Spec, search: Search, trajectory: Trajectory) -> NDArray[np.float64]:
    """The share of upright steps in the last fifth of each length, shape (seeds, lengths)."""
    shares = np.zeros((len(spec.seeds), len(search.lengths)))
    for row, seed in enumerate(spec.seeds):
        setting = prepare(spec, seed)
        setting.advance(trajectory, 0, max(search.lengths))
        upright = np.abs(trajectory.angle) <= UPRIGHT
        for column, length in enumerate(search.lengths):
            shares[row, column] = upright[last_fifth(length) : length].mean()
    return shares


def chosen(tried: pd.DataFrame) -> pd.DataFrame:
    """A row for each group: its chosen candidate, or how near its best came to being reliable."""
    rows = []
    for _, group in tried.groupby("group", sort=True):
        best: dict[str, Any] = {}
        for _, candidate in group.groupby(["architecture", "alpha"], sort=False):
            ordered = candidate.sort_values("steps")
            # Whether this length and all longer ones succeeded with every seed.
            reliable = (ordered["sure"] == ordered["seeds"])[::-1].cummin()[::-1]
            first = ordered[reliable]
            longest = ordered.iloc[-1]
            row = {
                **{name: longest[name] for name in KEPT},
                "steps": float(first["steps"].iloc[0]) if len(first) else np.inf,
                "sure": int(longest["sure"]),  # after the longest training
            }
            if not best or (row["steps"], -row["sure"]) < (best["steps"], -best["sure"]):
                best = row
        rows.append(best)
    return pd.DataFrame(rows)
