"""How probable is it, given the runs of a cell, that what a claim says of it is beyond its threshold?

For claims over readings: there a reading may have few runs, and a verdict by an interval would say
"inconclusive" of most. Here every reading says what it knows. Shares have Jeffreys' prior, so that k of
n leave Beta(k + ½, n − k + ½). Means have none: each run's value gets a weight, the weights being
uniform among those that sum to 1 (the Bayesian bootstrap, Rubin 1981). Runs of different cells are
independent.
"""

from functools import cache

import numpy as np
from numpy.typing import NDArray

from upswing.analysis.comparisons import counts, samples
from upswing.analysis.statistics import share_of_pairs
from upswing.runs.results import Results
from upswing.study.claim_parts import SHARES, Part
from upswing.study.claims import Claim

DRAWS = 2_000
SEED = 20_261_127
"""The seed of the draws; any will do, as long as it stays."""

Real = NDArray[np.float64]


def probability(results: Results, claim: Claim) -> float:
    """That all parts of a claim hold, each beyond its own threshold.

    Parts are taken to be independent given the runs, though they may share them: where they do, this is
    mostly a little low for two parts that hold together.
    """
    readings, product = results.study.readings, 1.0
    for part in claim.parts:
        if all(getattr(readings, key) == value for key, value in part.only_if.items()):
            for cells in part.comparisons:
                product *= beyond(results, part, cells)
    return product


def beyond(results: Results, part: Part, cells: tuple[str, ...]) -> float:
    """That a part holds for some cells."""
    drawn = draws(results, part, cells)
    holds = drawn >= part.threshold if part.is_lower else drawn <= part.threshold
    return float(holds.mean())


def draws(results: Results, part: Part, cells: tuple[str, ...]) -> Real:
    """What a part measures, drawn from its posterior, shape (DRAWS,)."""
    if part.kind in SHARES:
        shares = [
            _share(number, *counted) for number, counted in enumerate(counts(results, part, cells))
        ]
        match part.kind:
            case "difference_of_shares":
                return np.asarray(shares[0] - shares[1])
            case "range_of_shares":
                return np.asarray(np.max(shares, axis=0) - np.min(shares, axis=0))
        return np.asarray(shares[0])
    values = samples(results, part, cells)
    if part.kind == "probability_greater":
        n = min(len(values[0]), len(values[1]))
        successes = share_of_pairs(*values) * n if n else 0.0
        return _share(0, successes, n)
    if not all(len(one) for one in values):
        return np.full(DRAWS, np.nan)  # beyond nothing
    together = part.kind == "ratio_of_sums" or part.paired
    means = [
        _weights(len(one), 0 if together else number) @ one for number, one in enumerate(values)
    ]
    match part.kind:
        case (
            "location"
        ):  # whichever the statistic: its mean stands for the middle of a reading's runs
            return np.asarray(means[0])
        case "difference_of_means":
            return np.asarray(means[0] - means[1])
        case "range_of_means":
            return np.asarray(np.max(means, axis=0) - np.min(means, axis=0))
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(means[0] / means[1])


def _share(number: int, successes: float, n: int) -> Real:
    random = np.random.default_rng([SEED, number])
    return np.asarray(random.beta(successes + 0.5, n - successes + 0.5, DRAWS))


@cache
def _weights(n: int, number: int) -> Real:
    """Weights of runs that sum to 1, shape (DRAWS, n)."""
    drawn = np.random.default_rng([SEED, number]).exponential(size=(DRAWS, n))
    return np.asarray(drawn / drawn.sum(axis=1, keepdims=True))
