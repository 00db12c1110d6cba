"""Are the planned runs enough? Every verdict can be reached both ways, and is where the truth is clear."""

from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from upswing.analysis import statistics
from upswing.analysis.contraction import PROBLEMS
from upswing.study.claims import load_claims
from upswing.study.config import load
from upswing.study.matrix import Matrix
from upswing.study.task import kind_of_task

STUDY = load(Path("config/config.yaml"))
CELLS = Matrix(STUDY).cells
CLAIMS = load_claims(Path("config/claims.yaml"), STUDY)
CLEAR = 0.15
"""How far beyond its threshold a share is clear."""

STARTS = len(kind_of_task("full-control").greedy_starts)
PARTS = [
    pytest.param(part, cells, id=f"{name}.{number}-{cells[0] if cells else part.kind}")
    for name, claim in CLAIMS.items()
    for number, part in enumerate(claim.parts, 1)
    for cells in part.comparisons
]


def runs_of(part, cells):
    """How many runs each cell has; of those among which a part looks, about half."""
    if not cells:
        return [{"share_contracting": PROBLEMS, "share_represented": STARTS}[part.kind]]
    share = 2 if part.among else 1
    return [len(CELLS[cell].seeds) // share for cell in cells]


def extremes(part, counts):
    """The estimates where everything speaks for the claim, and where everything speaks against it."""
    low, high = 0.0, 1.0
    match part.kind:
        case "share" | "share_identical" | "share_contracting" | "share_represented":
            found = [statistics.share(0, counts[0]), statistics.share(counts[0], counts[0])]
        case "range_of_shares":
            alike = [(n // 2, n) for n in counts]
            apart = [(0 if k else n, n) for k, n in enumerate(counts)]
            found = [statistics.range_of_shares(alike), statistics.range_of_shares(apart)]
        case "probability_greater":
            one, other = np.full(counts[0], 1.0), np.full(counts[1], 0.0)
            found = [statistics.probability_greater(*pair) for pair in ((other, one), (one, other))]
        case _:  # means: of runs that are all alike
            low, high = part.partly - 1, part.threshold + 1
            if not part.is_lower:
                low, high = part.threshold - 0.5, part.partly + 0.5
            found = [statistics.mean(np.full(counts[0], value)) for value in (low, high)]
    return found if part.is_lower else found[::-1]


@pytest.mark.parametrize(("part", "cells"), PARTS)
def test_every_verdict_can_be_reached_both_ways(part, cells):
    against, for_it = extremes(part, runs_of(part, cells))
    assert part.verdict(against) == "not reproduced"
    assert part.verdict(for_it) == "reproduced"


SHARES = [one for one in PARTS if one.values[0].kind == "share"]


@pytest.mark.parametrize(("part", "cells"), SHARES)
def test_where_the_truth_is_clear_the_verdict_mostly_is(part, cells):
    """With four in five or more of such studies; a truth near the line stays at the line."""
    (n,) = runs_of(part, cells)
    k = np.arange(n + 1)
    verdicts = np.array([part.verdict(statistics.share(int(one), n)) for one in k])
    sign = 1 if part.is_lower else -1
    for truth, wanted in (
        (part.threshold + sign * CLEAR, "reproduced"),
        (part.partly - sign * CLEAR, "not reproduced"),
    ):
        likely = stats.binom.pmf(k, n, np.clip(truth, 0.0, 1.0))
        assert likely[verdicts == wanted].sum() >= 0.8
