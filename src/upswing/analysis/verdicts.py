"""Runs and claims → evidence (one row a comparison) → verdicts (one row a claim)."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from upswing.analysis import statistics, survival
from upswing.analysis.contraction import PROBLEMS, contracts
from upswing.analysis.statistics import Estimate
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.study.claims import (
    Bound,
    Claim,
    Part,
    Verdict,
    canonical_claims,
    cells_of_claims,
    weakest,
)
from upswing.study.errors import BadInput, near
from upswing.study.paths import EVIDENCE, VERDICTS

LEDGER = "verdicts"
"""The ledger of both tables; it has the claims by which they were judged."""


class Evidence(NamedTuple):
    """A comparison: the estimate of one part of a claim."""

    claim: str
    part: int  # from 1, in the order of the claim
    says: str
    cells: str
    measure: str
    threshold: str
    holds_from: float  # the threshold itself
    partly_from: float
    at_least: bool  # whether it is a lower one
    estimate: float
    low: float
    high: float
    n: int
    method: str
    spread_low: float  # 5th percentile of the runs' own values: the spread, no interval
    spread_high: float  # 95th
    p_value: float
    verdict: Verdict
    could_be_better: bool  # the interval reaches the threshold: "partly" means at least partly
    because: str


def write_verdicts(results: Results, claims: Mapping[str, Claim]) -> pd.DataFrame:
    """Judge every claim by the runs of ``results``; writes and returns the table of verdicts.

    Raises:
        BadInput: runs that claims are about are missing, or lack a measure that a claim asks for.
    """
    results.check_complete({cell for _, cell in cells_of_claims(claims)})
    verdicts, evidence = judge_all(results, claims)
    tables = [results.folder / EVIDENCE, results.folder / VERDICTS]
    for path, table in zip(tables, (evidence, verdicts), strict=True):
        write_table(path, table)
    seal(results.folder, LEDGER, tables, claims=canonical_claims(claims))
    return verdicts


def judge_all(results: Results, claims: Mapping[str, Claim]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The table of verdicts, and that of the evidence."""
    evidence = [row for name, claim in claims.items() for row in judge(results, name, claim)]
    return sum_up(results, claims, evidence), pd.DataFrame(evidence)


def judge(results: Results, name: str, claim: Claim) -> list[Evidence]:
    """The evidence for a claim: a row for each comparison of each of its parts."""
    readings = results.study.readings
    rows = []
    for number, part in enumerate(claim.parts, 1):
        asked = all(getattr(readings, key) == value for key, value in part.only_if.items())
        for cells in part.comparisons if asked else []:
            if missing := [cell for cell in cells if cell not in results.cells]:
                estimate = statistics.no_runs()
                verdict: Verdict = "not in this study"
                own = np.empty(0)
                says = f"{part.says}: needs {', '.join(missing)}"
            else:
                estimate = compare(results, part, cells)
                verdict = part.verdict(estimate)
                own = _own_values(results, part, cells)
                says = part.says
            rows.append(
                Evidence(
                    claim=name,
                    part=number,
                    says=says,
                    cells=" : ".join(cells),
                    measure=_measure(part),
                    threshold=part.threshold_text,
                    holds_from=part.threshold,
                    partly_from=float(part.partly),
                    at_least=part.is_lower,
                    estimate=estimate.value,
                    low=estimate.low,
                    high=estimate.high,
                    n=estimate.n,
                    method=estimate.method,
                    spread_low=statistics.spread(own)[0],
                    spread_high=statistics.spread(own)[1],
                    p_value=estimate.p_value(part.threshold, part.is_lower),
                    verdict=verdict,
                    could_be_better=part.could_be_better(estimate),
                    because=part.because,
                )
            )
    return rows


def compare(results: Results, part: Part, cells: tuple[str, ...]) -> Estimate:
    """The estimate of a part for some cells."""
    groups = [_among(results.counted(cell), part.among) for cell in cells]
    match part.kind:
        case "share_contracting":  # of made-up problems, and of no cell
            return statistics.share(sum(map(contracts, range(PROBLEMS))), PROBLEMS)
        case "share":
            fulfilled = _fulfilled(groups[0], part.where)
            return statistics.share(int(fulfilled.sum()), len(fulfilled))
        case "difference_of_shares":
            one, other = (list(_fulfilled(group, part.where)) for group in groups)
            return statistics.difference_of_shares(one, other)
        case "range_of_shares":
            return statistics.range_of_shares(
                [list(_fulfilled(group, part.where)) for group in groups]
            )
        case "share_identical":
            digests = _paired(groups, "digest")
            return statistics.share(int((digests[0] == digests[1]).sum()), len(digests[0]))
    assert part.measure is not None  # noqa: S101  the claim's own check has made sure
    match part.kind:
        case "share_by":
            times = [None if pd.isna(t) else float(t) for t in _column(groups[0], part.measure)]
            horizon = float(groups[0]["steps"].iloc[0])
            return survival.share_by(times, float(part.limit or 0), horizon)
        case "location":
            known = _column(groups[0], part.measure).dropna().to_numpy()
            return statistics.LOCATIONS[part.statistic](known)
        case "range_of_means":
            return statistics.range_of_means(_paired(groups, part.measure))
    x, y = _paired(groups, part.measure)
    functions = {
        "ratio_of_means": statistics.ratio_of_means,
        "difference_of_means": statistics.difference_of_means,
        "probability_greater": statistics.probability_greater,
    }
    return functions[part.kind](x, y)


def sum_up(results: Results, claims: Mapping[str, Claim], evidence: list[Evidence]) -> pd.DataFrame:
    """One row for each claim: that of its weakest evidence, with p values adjusted by Holm."""
    rows: list[dict[str, Any]] = []
    for name, claim in claims.items():
        own = [row for row in evidence if row.claim == name]
        verdict = weakest([row.verdict for row in own])
        # Of the weakest comparisons the one that is worst off, by its p value and then by its distance.
        decisive = max((row for row in own if row.verdict == verdict), key=_shortfall)
        rows.append(
            {
                "claim": name,
                "statement": claim.statement,
                "section": claim.section,
                "measure": decisive.says,
                "threshold": decisive.threshold,
                "estimate": decisive.estimate,
                "low": decisive.low,
                "high": decisive.high,
                "n": decisive.n,
                "method": decisive.method,
                "cells": decisive.cells,
                "p_value": max(row.p_value for row in own),
                "verdict": verdict,
                "could_be_better": decisive.could_be_better,
                "spread_low": decisive.spread_low,
                "spread_high": decisive.spread_high,
                "note": claim.note,
                "parts": len(own),
                "figure": claim.figure,
                "recordings": _recordings(results, claim.cell),
            }
        )
    for row, adjusted in zip(rows, statistics.holm([row["p_value"] for row in rows]), strict=True):
        row["p_holm"] = adjusted
    frame = pd.DataFrame(rows)
    return frame.astype({"figure": "Int64"}) if rows else frame


def _shortfall(row: Evidence) -> tuple[float, float]:
    """How far a comparison is from its threshold: its p value, and, where that is 1, the distance."""
    distance = row.holds_from - row.estimate
    return round(row.p_value, 9), distance if row.at_least else -distance


def _recordings(results: Results, cell: str | None) -> list[str]:
    """The recordings of the worst, the median and the best run of a cell."""
    if cell is None or cell not in results.cells:
        return []
    return [str(path) for path in results.three_of(cell)["recording"]]


def _among(runs: pd.DataFrame, conditions: Mapping[str, Bound]) -> pd.DataFrame:
    return runs[_fulfilled(runs, conditions)] if conditions else runs


def _fulfilled(runs: pd.DataFrame, conditions: Mapping[str, Bound]) -> pd.Series:
    fulfilled = pd.Series(True, index=runs.index)
    for measure, bound in conditions.items():
        fulfilled &= _column(runs, measure).map(bound)
    return fulfilled.astype(bool)


def _column(runs: pd.DataFrame, measure: str) -> pd.Series:
    if measure not in runs.columns:
        raise BadInput([f"claims: {measure}: no measure of a run; {near(measure, runs.columns)}"])
    if not pd.api.types.is_numeric_dtype(runs[measure]):
        raise BadInput([f"claims: {measure}: is no number in the table of runs"])
    return runs[measure].astype("float64")


def _paired(groups: list[pd.DataFrame], measure: str) -> list[NDArray[Any]]:
    """A measure of several cells, by the seeds that all of them have, in the same order."""
    if measure != "digest":
        for group in groups:
            _column(group, measure)  # it is there, and a number
    columns = [group.set_index("seed")[measure] for group in groups]
    seeds = columns[0].index
    for column in columns[1:]:
        seeds = seeds.intersection(column.index)
    if any(column.isna().any() for column in columns):
        raise BadInput([f"claims: {measure}: some runs have none; pairs of runs need one in each"])
    return [column.loc[seeds.sort_values()].to_numpy() for column in columns]


def _own_values(results: Results, part: Part, cells: tuple[str, ...]) -> NDArray[Any]:
    """The values whose spread is shown: of the first cell, the measure or what is counted."""
    measure = part.measure or next(iter(part.where), None)
    if not cells or measure is None:
        return np.empty(0)
    return _column(_among(results.counted(cells[0]), part.among), measure).dropna().to_numpy()


def _measure(part: Part) -> str:
    """What is measured, for readers of the table."""
    conditions = " and ".join(f"{name} {_words(bound)}" for name, bound in part.where.items())
    return part.measure or conditions or part.kind


def _words(bound: Bound) -> str:
    signs = {"at_least": "≥", "at_most": "≤", "below": "<"}
    return " ".join(f"{signs[key]} {value:g}" for key, value in bound if value is not None)
