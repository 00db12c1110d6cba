"""Which reading of the networks is the default: a rule fixed beforehand and charitable to the author.

The author used the same networks for figures 7, 9 and 11, so that one reading of R3 and R10–R12 has to
explain all three: the one under which what he reports is most likely,

    L = p₇ (1 − p₉) p₁₁ (1 − p₁₁),

on seeds that no verdict uses. A factor is the probability that a run shows what the figure shows. A run
that diverged shows neither a success nor a failure, so that under a reading whose networks overflow
nothing is likely: of figure 9, 1 − p₉ is the share of runs that stayed finite *and* do not stand.

Readings are many and runs are dear, so the selection goes in rounds (successive halving; Jamieson and
Talwalkar 2016): all readings with few seeds, the likeliest with more.
"""

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from upswing.analysis.robustness.read import read_sweep
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import seal
from upswing.runs.success import succeeds
from upswing.study.config import Study
from upswing.study.ids import CellId
from upswing.study.paths import finalists_of_sweep
from upswing.study.sweeps import Report, Sweep
from upswing.study.task import kind_of_task

DRAWS = 4_000
SEED = 20_261_126
"""The seed of the draws; any will do, as long as it stays."""

Real = NDArray[np.float64]


def write_finalists(results: Path, study: Study, name: str, sweep: Sweep, number: int) -> Path:
    """Say which readings go on to a round, by the runs of the rounds before; returns the file's path.

    Raises:
        BadInput: some of those runs are missing.
    """
    runs = read_sweep(results, name, sweep, study, before=number)
    ranked = select(runs, sweep.reports)["readings"]
    chosen = [json.loads(text) for text in ranked[: sweep.rounds[number - 2].readings]]
    path = results / finalists_of_sweep(name, number)
    with written(path) as beside:
        beside.write_text(json.dumps(chosen, indent=1) + "\n", "utf-8")
    seal(results, f"readings/{name}/round-{number}", [path])
    return path


def select(runs: pd.DataFrame, reports: Mapping[str, Report]) -> pd.DataFrame:
    """The readings with their likelihood, the most likely first.

    Args:
        runs: the rows of the sweep: every reading's runs of the reports' cells.
        reports: what the author reports, by name.

    Returns:
        One row a reading: its options; ``readings`` (JSON); of each report how many runs succeed, fail
        and diverged (``…_successes``, ``…_failures``, ``…_diverged``) and the share that succeeds, as
        (k + 1) / (n + 2); ``runs``, of all reports together; ``likelihood`` with a 95 % interval
        (``low``, ``high``), and the probability that it is the likeliest of those with most runs
        (``best``). Readings are compared within a round only: (k + 1) / (n + 2) flatters few runs. So
        those with most runs come first; equal ones stay in the order of the grid.
    """
    counted = counts(runs, reports)
    rows = []
    for text, of in counted.items():
        row = dict(json.loads(text)) | {"readings": text}
        for name, (successes, failures, diverged) in of.items():
            row |= {
                f"{name}_successes": successes,
                f"{name}_failures": failures,
                f"{name}_diverged": diverged,
                name: (successes + 1) / (successes + failures + diverged + 2),
            }
        row["runs"] = sum(sum(of[name]) for name in reports)
        row["likelihood"] = float(
            np.prod([estimate(report, of[name]) for name, report in reports.items()])
        )
        rows.append(row)
    frame = pd.DataFrame(rows)
    each = [
        draws(report, [of[name] for of in counted.values()], number)
        for number, (name, report) in enumerate(reports.items())
    ]
    drawn = np.prod(each, axis=0)
    frame["low"], frame["high"] = np.quantile(drawn, (0.025, 0.975), axis=1)
    finalists = (frame["runs"] == frame["runs"].max()).to_numpy()
    likeliest = np.where(finalists[:, None], drawn, 0.0).argmax(axis=0)
    frame["best"] = np.bincount(likeliest, minlength=len(frame)) / DRAWS
    return frame.sort_values(
        ["runs", "likelihood"], ascending=False, kind="stable", ignore_index=True
    )


Counts = tuple[int, int, int]
"""How many runs succeed, fail and diverged."""


def counts(runs: pd.DataFrame, reports: Mapping[str, Report]) -> dict[str, dict[str, Counts]]:
    """For each reading (JSON) the runs of each report's cell."""
    found: dict[str, dict[str, Counts]] = {}
    own = runs[runs["cell"].isin({report.cell for report in reports.values()})]
    for (readings, cell), of in own.groupby(["readings", "cell"], sort=False):
        finite = of["diverged_at"].isna()
        won = int((succeeds(of, kind_of_task(CellId.parse(str(cell)).task)) & finite).sum())
        for name, report in reports.items():
            if report.cell == cell:
                lost = int(finite.sum()) - won
                found.setdefault(str(readings), {})[name] = (won, lost, int((~finite).sum()))
    return {text: of for text, of in found.items() if len(of) == len(reports)}


def estimate(report: Report, of: Counts) -> float:
    """How likely a run, or two, show what the author reports."""
    won, lost = ((count + 1) / (sum(of) + 2) for count in of[:2])
    return {"success": won, "failure": lost, "both": won * lost}[report.shows]


def draws(
    report: Report, of: list[Counts], number: int, prior: tuple[float, float] = (1.0, 1.0)
) -> Real:
    """That likelihood drawn from its posterior, shape (readings, DRAWS).

    Args:
        report: what the author reports.
        of: the runs of each reading.
        number: that of the report, so that each has draws of its own.
        prior: the Beta distribution of the share that succeeds; flat without it.
    """
    won, lost, diverged = (np.array(column)[:, None] for column in zip(*of, strict=True))
    random = np.random.default_rng([SEED, number])
    a, b = prior
    success = random.beta(won + a, lost + diverged + b, (len(of), DRAWS))
    finite = random.beta(lost + 1, diverged + 1, (len(of), DRAWS))
    failure = (1 - success) * np.where(diverged == 0, 1.0, finite)
    found = {"success": success, "failure": failure, "both": success * failure}[report.shows]
    return np.asarray(found)
