"""Every claim judged under every reading of the sweeps, and which readings decide it."""

import json
from collections.abc import Iterator, Mapping
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from upswing.analysis.posterior import probability
from upswing.analysis.robustness.selection import counts
from upswing.analysis.robustness.weighing import grade, weigh
from upswing.analysis.verdicts import evidence_of, sum_up
from upswing.runs.results import Results
from upswing.study.claims import Claim
from upswing.study.config import Study
from upswing.study.matrix import Matrix
from upswing.study.spec import Spec
from upswing.study.sweeps import Sweep, canonical_of, label, number_of, specs

HOLDS = ("reproduced", "partly")
"""Verdicts under which a claim holds, at least partly."""

BEST_PAIRS = 2
"""Number of pairs of options named of a pair of readings."""

Row = dict[str, Any]


class Swept(Results):
    """The runs of a sweep under one reading, read as if they were the results of a study."""

    def __init__(
        self, study: Study, cells: Mapping[str, Spec], runs: pd.DataFrame, tiles: pd.DataFrame
    ) -> None:
        super().__init__(Path())
        # What a folder of results would be asked for.
        self.__dict__.update(study=study, cells=cells, runs=runs, tile_policy=tiles)


def robustness(
    sweeps: Mapping[str, Sweep],
    study: Study,
    claims: Mapping[str, Claim],
    runs: Mapping[str, pd.DataFrame],
    tiles: pd.DataFrame,
) -> pd.DataFrame:
    """One row for each reading and claim: estimate, interval and verdict.

    Args:
        sweeps: all sweeps by name.
        study: whose readings are varied.
        claims: all claims; each is judged in the sweep that varies most of what can touch it.
        runs: the rows of each sweep.
        tiles: what a policy on the tiles came to, which no reading changes.

    Returns:
        Columns ``sweep``, ``readings`` (JSON), ``label``, a column for each varied reading, ``claim``,
        ``measure``, ``threshold``, ``estimate``, ``low``, ``high``, ``n``, ``verdict``,
        ``could_be_better``, ``holds`` (by its interval, at least partly), ``estimate_holds`` (every
        estimate reaches its threshold, however sure), ``probability`` (that all of it holds, given the
        runs) and ``is_default``.
    """
    rows: list[Row] = []
    for name, sweep in sweeps.items():
        own = {
            key: claim for key, claim in claims.items() if sweep_of(claim, sweeps, study) == name
        }
        is_beside = runs[name]["cell"].isin(sweep.beside)
        beside = runs[name][is_beside]
        for text, under in runs[name][~is_beside].groupby("readings", sort=False):
            overrides = json.loads(str(text))
            there = pd.concat([under, beside], ignore_index=True)
            rows += _judged(name, sweep, study, own, overrides, there, tiles)
    return pd.DataFrame(rows)


def sweep_of(claim: Claim, sweeps: Mapping[str, Sweep], study: Study) -> str | None:
    """The sweep that varies most of the readings that touch a claim's own cell, if any does."""
    best, most = None, 0
    for name, sweep in sweeps.items():
        if claim.cell not in (*sweep.cells, *sweep.cells_of_singles, *sweep.cells_of_rounds):
            continue
        spec = next(s for s in specs(sweep, study, {}) if s.cell == claim.cell)
        touching = study.readings.touching(
            spec.architecture.learner, spec.task.kind, spec.architecture.is_modular
        )
        if (count := len(set(touching) & set(sweep.vary))) > most:
            best, most = name, count
    return best


def _judged(
    name: str,
    sweep: Sweep,
    study: Study,
    claims: Mapping[str, Claim],
    overrides: Row,
    runs: pd.DataFrame,
    tiles: pd.DataFrame,
) -> Iterator[Row]:
    there, known = set(runs["cell"]), Matrix(study).cells
    cells = {cell: known[cell] for cell in sweep.beside}
    cells |= {spec.cell: spec for spec in specs(sweep, study, overrides) if spec.cell in there}
    readings = study.readings.model_copy(update=overrides)
    swept = Swept(study.model_copy(update={"readings": readings}), cells, runs, tiles)
    asked = {
        key: claim
        for key, claim in claims.items()
        if all(
            cell in cells for part in claim.parts for group in part.comparisons for cell in group
        )
    }
    evidence = evidence_of(swept, asked)
    for verdict in sum_up(swept, asked, evidence).to_dict("records"):
        yield {
            "sweep": name,
            "readings": canonical_of(overrides),
            "label": label(overrides),
            **{reading: _option(getattr(readings, reading)) for reading in sweep.vary},
            **{
                str(key): verdict[key]
                for key in (
                    "claim", "measure", "threshold", "estimate", "low", "high", "n", "verdict",
                    "could_be_better",
                )
            },
            "holds": verdict["verdict"] in HOLDS,
            "estimate_holds": all(
                row.estimate >= row.holds_from if row.at_least else row.estimate <= row.holds_from
                for row in evidence
                if row.claim == verdict["claim"]
            ),
            "probability": probability(swept, asked[verdict["claim"]]),
            "is_default": readings == study.readings,
        }  # fmt: skip


def _option(value: Any) -> str:
    return f"{value:g}" if isinstance(value, int | float) else str(value)


def decisive(judged: pd.DataFrame, sweeps: Mapping[str, Sweep]) -> pd.DataFrame:
    """What decides each claim: readings alone and in pairs, the strongest first.

    In a grid, the share of the variance of ``estimate_holds`` that a reading's main effect or a pair's
    interaction explains. In a sweep of single changes and pairs, the share of the readings with that
    change (or that pair, where neither change alone does it) that turn the claim from what it is by
    default.

    Returns:
        Columns ``claim``, ``sweep``, ``readings`` (their numbers), ``names``, ``effect`` in 0 … 1, and
        ``under`` (the shares of each option under which the claim holds, or the changes that matter).
    """
    rows: list[Row] = []
    for (claim, name), of in judged.groupby(["claim", "sweep"], sort=False):
        sweep = sweeps[str(name)]
        find = _of_grid if sweep.how == "grid" else _of_changes
        found = [
            {"claim": claim, "sweep": name, **row}
            for row in find(of, sweep)
            if row["effect"] > 0.005
        ]
        rows += sorted(found, key=lambda row: -row["effect"])
    columns = ["claim", "sweep", "readings", "names", "effect", "under"]
    return pd.DataFrame(rows, columns=columns)


def _of_grid(of: pd.DataFrame, sweep: Sweep) -> Iterator[Row]:
    holds = of["estimate_holds"].to_numpy(float)
    total = float(((holds - holds.mean()) ** 2).sum())
    if total == 0:
        return
    explained: dict[tuple[str, ...], float] = {}
    for names in (*((name,) for name in sweep.vary), *combinations(sweep.vary, 2)):
        means = of.groupby([*names])["estimate_holds"].transform("mean").to_numpy(float)
        share = float(((means - holds.mean()) ** 2).sum()) / total
        explained[names] = share - sum(explained[(name,)] for name in names if len(names) > 1)
        yield {
            "readings": " × ".join(number_of(name) for name in names),
            "names": " × ".join(names),
            "effect": max(0.0, explained[names]),
            "under": _shares(of, names),
        }


def _shares(of: pd.DataFrame, names: tuple[str, ...]) -> str:
    """The share of each option, or of the pairs of options under which the claim holds most often."""
    shares = []
    for options, group in of.groupby([of[name] for name in names], sort=False):
        words = " & ".join(str(option) for option in options)
        shares.append((float(group["estimate_holds"].mean()), words))
    if len(names) > 1:
        shares = sorted(shares, key=lambda pair: -pair[0])[:BEST_PAIRS]
        return "most with " + ", ".join(f"{words}: {share:.0%}" for share, words in shares)
    return ", ".join(f"{words}: {share:.0%}" for share, words in shares)


def _of_changes(of: pd.DataFrame, sweep: Sweep) -> Iterator[Row]:
    if not (is_default := of["readings"] == "{}").any():
        return  # it was asked under readings that go on to a later round, and the default did not
    default = bool(of.loc[is_default, "estimate_holds"].iloc[0])
    found = [tuple(sorted(json.loads(str(text)).items())) for text in of["readings"]]
    flips = {
        keys: bool(holds) != default
        for keys, holds in zip(found, of["estimate_holds"], strict=True)
    }
    for name in sweep.vary:
        own = {keys: flip for keys, flip in flips.items() if name in dict(keys)}
        alone = [f"{dict(keys)[name]}" for keys, flip in own.items() if flip and len(keys) == 1]
        if own and alone:
            yield {
                "readings": number_of(name),
                "names": name,
                "effect": float(np.mean(list(own.values()))),
                "under": f"{'fails' if default else 'holds'} with {', '.join(alone)}",
            }
    for keys, flip in flips.items():
        if flip and len(keys) == 2 and not any(flips.get((key,), False) for key in keys):
            yield {
                "readings": " × ".join(number_of(name) for name, _ in keys),
                "names": " × ".join(name for name, _ in keys),
                "effect": 1 / len(flips),
                "under": f"{'fails' if default else 'holds'} with "
                + " & ".join(str(option) for _, option in keys),
            }


def summary(
    judged: pd.DataFrame,
    sweeps: Mapping[str, Sweep],
    claims: Mapping[str, Claim],
    runs: Mapping[str, pd.DataFrame],
) -> pd.DataFrame:
    """One row a claim: under how many readings it holds, and how probable it is over all of them.

    Columns ``claim``, ``sweep``, ``readings`` (how many), ``holds`` and ``estimate_holds`` (how many of
    them), ``default`` (the verdict under the default, with the sweep's seeds), one for each verdict;
    ``held_share`` (of the readings: under how many it is more probable than not), ``weighted_share``
    with ``weighted_low`` and ``weighted_high`` (``weighing``), ``grade``, ``left_out`` (reports about
    its own cells) and ``by_prior`` (the weighted share under other priors, in words).
    """
    rows = []
    counted = {name: counts(runs[name], sweep.reports) for name, sweep in sweeps.items()}
    for (claim, name), of in judged.groupby(["claim", "sweep"], sort=False):
        verdicts = of["verdict"].value_counts()
        chosen = of.loc[of["is_default"], "verdict"]
        probabilities = of["probability"].to_numpy(float)
        weighed = weigh(
            sweeps[str(name)],
            claims[str(claim)],
            [json.loads(text) for text in of["readings"]],
            probabilities,
            [counted[str(name)].get(text, {}) for text in of["readings"]],
        )
        others = (f"{prior}: {share:.2f}" for prior, share in weighed.by_prior.items())
        rows.append(
            {
                "claim": claim,
                "sweep": name,
                "readings": len(of),
                "holds": int(of["holds"].sum()),
                "estimate_holds": int(of["estimate_holds"].sum()),
                "default": chosen.iloc[0] if len(chosen) else "",
                **{
                    verdict: int(verdicts.get(verdict, 0))
                    for verdict in ("reproduced", "partly", "inconclusive", "not reproduced")
                },
                "held_share": float((probabilities >= 0.5).mean()),
                "weighted_share": weighed.share,
                "weighted_low": weighed.low,
                "weighted_high": weighed.high,
                "grade": grade(weighed.share),
                "left_out": ", ".join(weighed.left_out),
                "by_prior": "; ".join(others),
            }
        )
    # C2 before C10, and any other name in its place.
    rows.sort(key=lambda row: (len(str(row["claim"])), str(row["claim"])))
    return pd.DataFrame(rows)
