"""How probable is a claim over all readings, given what *else* the author reports?

    P(C) = Σ_r w(r) · P(C | runs under r),      w(r) ∝ prior(r) · Π likelihood of a report under r

The author used one reading and did not say which. What he reports of other figures says how likely each
is; a report about a cell that the claim itself is about is left out, or the claim would testify for
itself. P(C | runs under r) is ``posterior.probability``.

Assumptions: the readings that are swept are the ones that could have been meant; a report counts as one
run that the figure shows (of figure 11, one that succeeds and one that does not); the reports are
independent given the reading. What the answer owes to the prior is shown by three others.
"""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import optimize, stats

from upswing.analysis.robustness.selection import DRAWS, Counts, draws
from upswing.study.claims import Claim, cells_of_claims
from upswing.study.sweeps import Overrides, Report, Sweep

Real = NDArray[np.float64]
Prior = Callable[[list[Overrides]], Real]
"""A weight for each reading, shape (readings,), of any sum."""

HOLDS, FAILS = 0.95, 0.05
"""From where on a claim holds over readings, and up to where it fails."""

COARSE = (0.03, 0.1, 0.3, 0.5, 1)
"""The rates η that a first, coarse grid had."""

BELOW = 0.2


class Weighed(NamedTuple):
    """A claim over readings."""

    share: float  # P(C)
    low: float  # the 95 % interval that the uncertainty of the weights leaves
    high: float
    left_out: tuple[str, ...]  # the reports that are about the claim's own cells
    by_prior: dict[str, float]  # P(C) under other priors


def weigh(
    sweep: Sweep,
    claim: Claim,
    readings: list[Overrides],
    probabilities: Real,
    counted: list[Mapping[str, Counts]],
) -> Weighed:
    """A claim over the readings of a sweep.

    Args:
        sweep: what was swept; its reports weigh the readings.
        claim: the claim.
        readings: those under which it was asked.
        probabilities: that it holds under each, shape (readings,).
        counted: of each reading, how many runs of each report succeed, fail and diverged.
    """
    own = {cell for _, cell in cells_of_claims({"": claim})}
    asked = {name: report for name, report in sweep.reports.items() if report.cell not in own}
    drawn = likelihoods_drawn(asked, counted)
    likely = likelihoods(asked, counted)
    others = {
        name: _share(probabilities, prior(readings) * likely)
        for name, prior in priors(sweep).items()
        if prior(readings).any()
    }
    flat = np.ones(len(readings))
    uncertain = [_share(probabilities, flat * one) for one in drawn.T]
    low, high = np.quantile(uncertain, (0.025, 0.975))
    left_out = tuple(name for name in sweep.reports if name not in asked)
    return Weighed(_share(probabilities, flat * likely), float(low), float(high), left_out, others)


def likelihoods(reports: Mapping[str, Report], counted: list[Mapping[str, Counts]]) -> Real:
    """How likely the reports are under each reading, as expected, shape (readings,)."""
    each = [_expected(report, [of[name] for of in counted]) for name, report in reports.items()]
    return np.asarray(np.prod(each, axis=0)) if each else np.ones(len(counted))


def likelihoods_drawn(reports: Mapping[str, Report], counted: list[Mapping[str, Counts]]) -> Real:
    """The same drawn from the posterior of each reading, shape (readings, DRAWS)."""
    columns = {name: [of[name] for of in counted] for name in reports}
    each = [
        draws(report, columns[name], number, _prior(columns[name]))
        for number, (name, report) in enumerate(reports.items())
    ]
    return np.asarray(np.prod(each, axis=0)) if each else np.ones((len(counted), DRAWS))


def _expected(report: Report, of: list[Counts]) -> Real:
    won, lost, diverged = (np.array(column, dtype=float) for column in zip(*of, strict=True))
    prior = _prior(of)
    a, b = won + prior[0], lost + diverged + prior[1]
    finite = np.where(diverged == 0, 1.0, (lost + 1) / (lost + diverged + 2))
    found = {
        "success": a / (a + b),
        "failure": b / (a + b) * finite,
        "both": a * b / ((a + b) * (a + b + 1)) * finite,  # E p − E p²
    }
    return np.asarray(found[report.shows])


def _prior(of: list[Counts]) -> tuple[float, float]:
    return prior_of_shares([won for won, _, _ in of], [sum(one) for one in of])


def prior_of_shares(successes: Any, runs: Any) -> tuple[float, float]:
    """The Beta distribution that the readings' own shares come from, by maximum likelihood.

    Readings have from a handful to a thousand runs. A flat prior would tell of every reading with few
    runs and no success that a share of 1/(n + 2) is to be expected, and there are many such; so the
    prior of a share is learned from all readings together (empirical Bayes).
    """

    def surprise(logs: Real) -> float:
        a, b = np.exp(np.clip(logs, -4, 6))
        return -float(stats.betabinom.logpmf(successes, runs, a, b).sum())

    found = optimize.minimize(surprise, np.zeros(2), method="Nelder-Mead")
    a, b = np.exp(np.clip(found.x, -4, 6))
    return float(a), float(b)


def priors(sweep: Sweep) -> dict[str, Prior]:
    """Other priors than a flat one, by name: of a grid over η, and of single changes."""
    if sweep.how == "pairs":
        return {"one change at most": lambda readings: _where(len(r) <= 1 for r in readings)}
    if "learning_rate" not in sweep.vary:
        return {}

    def rates(readings: list[Overrides]) -> Real:
        return np.array([one["learning_rate"] for one in readings], dtype=float)

    return {
        f"only η < {BELOW:g}": lambda readings: (rates(readings) < BELOW).astype(float),
        "coarse grid of η": lambda readings: np.isin(rates(readings), COARSE).astype(float),
        "even in log η": lambda readings: _even_in_log(rates(readings)),
    }


def grade(share: float) -> str:
    """What the probability of a claim over readings comes to."""
    if share >= HOLDS:
        return "holds"
    return "fails" if share <= FAILS else "depends on the reading"


def _where(conditions: Any) -> Real:
    return np.array([float(condition) for condition in conditions])


def _even_in_log(rates: Real) -> Real:
    """Weights by which each piece of log η counts for its length."""
    known = np.unique(rates)
    if len(known) == 1:
        return np.ones(len(rates))
    borders = np.log(known)
    middles = (borders[1:] + borders[:-1]) / 2
    ends = np.concatenate([[borders[0]], middles, [borders[-1]]])
    lengths = dict(zip(known.tolist(), np.diff(ends).tolist(), strict=True))
    return np.array([lengths[rate] for rate in rates.tolist()])


def _share(probabilities: Real, weights: Real) -> float:
    return float(probabilities @ weights / weights.sum())
