"""A part of a claim → its estimate: what is compared, of runs that count."""

from collections.abc import Mapping
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from upswing.analysis import statistics, survival
from upswing.analysis.statistics import Estimate
from upswing.runs.results import Results
from upswing.study.claim_parts import SHARES, Bound, Part
from upswing.study.errors import BadInput, near

CONTRACTION = "upswing.analysis.contraction"
"""What C16 asks; ``study/jobs.py`` names it for the jobs that judge."""


def compare(results: Results, part: Part, cells: tuple[str, ...]) -> Estimate:
    """The estimate of a part for some cells."""
    if part.kind == "share_by":
        runs = _among(results.counted(cells[0]), part.among)
        times = [None if pd.isna(t) else float(t) for t in _column(runs, str(part.measure))]
        return survival.share_by(times, float(part.limit or 0), float(results.task(cells[0]).steps))
    if part.kind in SHARES:
        counted = counts(results, part, cells)
        match part.kind:
            case "difference_of_shares":
                return statistics.difference_of_shares(counted[0], counted[1])
            case "range_of_shares":
                return statistics.range_of_shares(counted)
        return statistics.share(*counted[0])
    values = samples(results, part, cells)
    match part.kind:
        case "location":
            return statistics.LOCATIONS[part.statistic](values[0])
        case "range_of_means":
            return statistics.range_of_means(values)
    x, y = values
    if part.paired:
        return statistics.difference_of_pairs(x, y)
    functions = {
        "ratio_of_means": statistics.ratio_of_means,
        "ratio_of_sums": statistics.ratio_of_sums,
        "difference_of_means": statistics.difference_of_means,
        "probability_greater": statistics.probability_greater,
    }
    return functions[part.kind](x, y)


def counts(results: Results, part: Part, cells: tuple[str, ...]) -> list[tuple[int, int]]:
    """How many of how many fulfil what a part counts, for each of its cells, or once for all."""
    match part.kind:
        case "share_contracting":  # of made-up problems, and of no cell
            return [_contracting()]
        case "share_represented":  # of the starts, by a policy on the tiles that was found
            starts = results.tile_policy
            return [(int(starts["success"].sum()), len(starts))]
    groups = [_among(results.counted(cell), part.among) for cell in cells]
    match part.kind:
        case "share_identical":
            one, other = (group.set_index("seed")["digest"] for group in groups)
            both = one.index.intersection(other.index)
            same = one.loc[both].to_numpy() == other.loc[both].to_numpy()
            return [(int(same.sum()), len(both))]
        case "share_by":
            reached = _column(groups[0], str(part.measure)) <= float(part.limit or 0)
            return [(int(reached.sum()), len(reached))]
    fulfilled = [_fulfilled(group, part.where) for group in groups]
    return [(int(one.sum()), len(one)) for one in fulfilled]


def samples(results: Results, part: Part, cells: tuple[str, ...]) -> list[NDArray[Any]]:
    """What a part measures: of each cell, shape (runs,), or of one cell two measures."""
    groups = [_among(results.counted(cell), part.among) for cell in cells]
    if part.kind == "location":
        return [_column(groups[0], str(part.measure)).dropna().to_numpy()]
    if part.kind == "ratio_of_sums":
        return [_known(groups[0], name) for name in (str(part.measure), str(part.per))]
    if part.paired:
        seeds = set.intersection(*(set(group["seed"]) for group in groups))
        groups = [group[group["seed"].isin(seeds)].sort_values("seed") for group in groups]
    return [_known(group, str(part.measure)) for group in groups]


@cache
def _contracting() -> tuple[int, int]:
    """Loaded by name, for it brings the table along: a figure need not be drawn anew with that."""
    contraction: Any = import_module(CONTRACTION)
    problems = contraction.PROBLEMS
    return sum(map(contraction.contracts, range(problems))), problems


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


def _known(runs: pd.DataFrame, measure: str) -> NDArray[Any]:
    """A measure of every run, shape (runs,)."""
    column = _column(runs, measure)
    if column.isna().any():
        raise BadInput([f"claims: {measure}: some runs have none; it cannot be compared"])
    return column.to_numpy()


def own_values(results: Results, part: Part, cells: tuple[str, ...]) -> NDArray[Any]:
    """The values whose spread is shown: of the first cell, the measure or what is counted."""
    return by_seed(results, part, cells[0]).to_numpy() if cells else np.empty(0)


def by_seed(results: Results, part: Part, cell: str) -> pd.Series:
    """What a part measures or counts of the runs of a cell that it looks at, where it is known."""
    measure = part.measure or next(iter(part.where), None)
    if measure is None:
        return pd.Series(dtype="float64")
    runs = _among(results.counted(cell), part.among)
    return _column(runs, measure).set_axis(runs["seed"]).dropna()
