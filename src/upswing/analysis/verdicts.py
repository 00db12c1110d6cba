"""Runs and claims → evidence (one row a comparison) → verdicts (one row a claim)."""

import json
from collections.abc import Mapping
from math import inf
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from upswing.analysis import statistics
from upswing.analysis.comparisons import compare, own_values
from upswing.analysis.fragility import fragile_because
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.study.claim_parts import NOT_HERE, Bound, Part, Verdict, weakest
from upswing.study.claims import Claim, canonical_claims, cells_of_claims
from upswing.study.paths import EVIDENCE, LEDGER_OF_VERDICTS, VERDICTS


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
    verdict: Verdict
    could_be_better: bool  # the interval reaches the threshold: "partly" means at least partly
    at_threshold: bool  # a line lies within the interval
    diverged: int  # runs of these cells that are left out, for their values overflowed
    because: str


Over = Mapping[str, Mapping[str, Any]]
"""What the readings say of each claim: rows of the table ``robust``, by claim."""

OVER_READINGS = ("held_share", "weighted_share", "weighted_low", "weighted_high", "grade")
"""What a verdict takes over from there."""

ENOUGH = 0.05
"""The share of the readings' weight under which a claim comes out otherwise that makes it fragile."""


def write_verdicts(results: Results, claims: Mapping[str, Claim], over: Over) -> pd.DataFrame:
    """Judge every claim by the runs of ``results``; writes and returns the table of verdicts.

    Args:
        results: the runs.
        claims: those to judge.
        over: what the readings say of each, where they have been asked.

    Raises:
        BadInput: runs that claims are about are missing, or lack a measure that a claim asks for.
    """
    results.check_complete({cell for _, cell in cells_of_claims(claims)})
    verdicts, evidence = judge_all(results, claims, over)
    tables = [results.folder / EVIDENCE, results.folder / VERDICTS]
    for path, table in zip(tables, (evidence, verdicts), strict=True):
        write_table(path, table)
    judged_by = {"claims": canonical_claims(claims), "readings": canonical_over(over)}
    seal(results.folder, LEDGER_OF_VERDICTS, tables, **judged_by)
    return verdicts


def canonical_over(over: Over) -> str:
    """What the readings say as one line: the same text for the same meaning."""
    taken = {claim: {name: row[name] for name in OVER_READINGS} for claim, row in over.items()}
    return json.dumps(taken, sort_keys=True)


def judge_all(
    results: Results, claims: Mapping[str, Claim], over: Over
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The table of verdicts, and that of the evidence."""
    evidence = evidence_of(results, claims)
    because = fragile_because(
        results,
        verdicts_by(claims, evidence),
        lambda seen: verdicts_by(claims, evidence_of(seen, claims)),
    )
    verdicts = sum_up(results, claims, evidence)
    rows: list[dict[str, Any]] = []
    for each in verdicts.to_dict("records"):
        row = {str(name): value for name, value in each.items()}
        of_claim = over.get(row["claim"], {})
        why = [*because[row["claim"]], *_other_readings(row["verdict"], of_claim)]
        taken = {name: of_claim.get(name) for name in OVER_READINGS}
        rows.append({**row, **taken, "fragile": bool(why), "fragile_because": "; ".join(why)})
    columns: dict[str, Any] = {name: "float64" for name in OVER_READINGS if name != "grade"}
    columns |= {"grade": "string", "figure": "Int64"}
    frame = pd.DataFrame(rows)
    return (frame.astype(columns) if rows else frame), pd.DataFrame(evidence)


def _other_readings(verdict: str, over: Mapping[str, Any]) -> list[str]:
    """Whether the readings make a verdict fragile, in words; their weight is that it holds in full."""
    weight = over.get("weighted_share")
    if weight is None or np.isnan(weight) or verdict == "inconclusive":
        return []
    otherwise = 1 - weight if verdict == "reproduced" else weight
    if otherwise < ENOUGH:
        return []
    return [f"other readings, with {otherwise:.0%} of the weight, say otherwise"]


def evidence_of(results: Results, claims: Mapping[str, Claim]) -> list[Evidence]:
    """The evidence for all claims."""
    return [row for name, claim in claims.items() for row in judge(results, name, claim)]


def verdicts_by(claims: Mapping[str, Claim], evidence: list[Evidence]) -> dict[str, Verdict]:
    """The verdict on each claim: that of its weakest evidence."""
    return {
        name: weakest([row.verdict for row in evidence if row.claim == name]) for name in claims
    }


def judge(results: Results, name: str, claim: Claim) -> list[Evidence]:
    """The evidence for a claim: a row for each comparison of each of its parts."""
    readings = results.study.readings
    rows = []
    for number, part in enumerate(claim.parts, 1):
        asked = all(getattr(readings, key) == value for key, value in part.only_if.items())
        for cells in part.comparisons if asked else []:
            needed = cells or tuple(filter(None, [claim.cell]))  # made-up problems need none
            if missing := [cell for cell in needed if cell not in results.cells]:
                estimate = statistics.no_runs()
                verdict: Verdict = NOT_HERE
                own = np.empty(0)
                says = f"{part.says}: needs {', '.join(missing)}"
            else:
                estimate = compare(results, part, cells)
                verdict = part.verdict(estimate)
                own = own_values(results, part, cells)
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
                    verdict=verdict,
                    could_be_better=part.could_be_better(estimate),
                    at_threshold=verdict != NOT_HERE and part.at_threshold(estimate),
                    diverged=_diverged(results, cells),
                    because=part.because,
                )
            )
    return rows


def sum_up(results: Results, claims: Mapping[str, Claim], evidence: list[Evidence]) -> pd.DataFrame:
    """One row for each claim: that of its weakest evidence."""
    rows: list[dict[str, Any]] = []
    for name, verdict in verdicts_by(claims, evidence).items():
        claim, own = claims[name], [row for row in evidence if row.claim == name]
        decisive = max((row for row in own if row.verdict == verdict), key=_shortfall)
        taken = decisive._asdict()
        rows.append(
            {
                "claim": name,
                "statement": claim.statement,
                "section": claim.section,
                "check": claim.check,
                "measure": decisive.says,
                **{key: taken[key] for key in OF_THE_DECISIVE},
                "diverged": max(row.diverged for row in own),
                "note": claim.note,
                "parts": len(own),
                "figure": claim.figure if isinstance(claim.figure, int) else None,
                "recordings": _recordings(results, claim.cell),
            }
        )
    return pd.DataFrame(rows)


OF_THE_DECISIVE = (
    "threshold", "estimate", "low", "high", "n", "method", "cells", "verdict", "could_be_better",
    "at_threshold", "spread_low", "spread_high",
)  # fmt: skip
"""What a verdict's row has of the weakest comparison."""


def _shortfall(row: Evidence) -> float:
    """How far a comparison is from its threshold, in halves of its interval; the further, the worse."""
    distance = (row.holds_from - row.estimate) * (1 if row.at_least else -1)
    half = (row.high - row.low) / 2
    return inf if np.isnan(distance) else distance / max(half, 1e-9)


def _recordings(results: Results, cell: str | None) -> list[str]:
    """The recordings of the worst, the median and the best run of a cell."""
    if cell is None or cell not in results.cells:
        return []
    return [str(path) for path in results.three_of(cell)["recording"]]


def _diverged(results: Results, cells: tuple[str, ...]) -> int:
    """How many runs of these cells diverged."""
    known = [cell for cell in cells if cell in results.cells]
    return sum(int(results.cell(cell)["diverged_at"].notna().sum()) for cell in known)


def _measure(part: Part) -> str:
    """What is measured, for readers of the table."""
    conditions = " and ".join(f"{name} {_words(bound)}" for name, bound in part.where.items())
    return part.measure or conditions or part.kind


def _words(bound: Bound) -> str:
    signs = {"at_least": "≥", "at_most": "≤", "below": "<"}
    return " ".join(f"{signs[key]} {value:g}" for key, value in bound if value is not None)
