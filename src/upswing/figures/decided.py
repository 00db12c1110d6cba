"""What decides the claims that a figure shows: estimates and runs, as the verdicts have them."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.analysis.comparisons import by_seed, compare, counts, samples
from upswing.analysis.statistics import Estimate
from upswing.analysis.verdicts import Evidence, judge
from upswing.runs.results import Results
from upswing.study.claim_parts import Part
from upswing.study.claims import Claim

Real = NDArray[np.float64]

NOT_HERE = "not in this study"


class Dots(NamedTuple):
    """A row of a panel: what is measured of each run of a cell."""

    cell: str
    seeds: list[int]
    values: Real  # (runs,)


class Row(NamedTuple):
    """An estimate, and the rows of dots that it is of."""

    estimate: Estimate
    dots: list[Dots]  # none where nothing is measured run by run
    counted: tuple[int, int] | None  # how many of how many, then
    beside: bool = False  # no evidence: it is shown for comparison


class Decided(NamedTuple):
    """A part of a claim, as the study has it."""

    claim: str
    part: Part
    evidence: list[Evidence]  # a row for each of its comparisons
    rows: list[Row]  # the same, and those for comparison


def decided(
    results: Results, claims: Mapping[str, Claim], beside: Sequence[str] = ()
) -> tuple[list[Decided], list[str]]:
    """What the study says of each part of the claims, and the claims of which it lacks cells.

    Args:
        results: the runs.
        claims: those that a figure shows.
        beside: cells that are shown beside a share of another cell of the same architecture.
    """
    found: list[Decided] = []
    lacking: list[str] = []
    for name, claim in claims.items():
        evidence = judge(results, name, claim)
        if any(row.verdict == NOT_HERE for row in evidence):
            lacking.append(name)
        for number, part in enumerate(claim.parts, 1):
            own = [row for row in evidence if row.part == number and row.verdict != NOT_HERE]
            if not own:
                continue
            rows = [_row(results, part, row) for row in own]
            if part.kind == "share" and len(own) == 1:
                rows += _beside(results, part, own[0].cells, beside)
            found.append(Decided(name, part, own, rows))
    return found, lacking


def _row(results: Results, part: Part, row: Evidence) -> Row:
    cells = tuple(filter(None, row.cells.split(" : ")))
    estimate = Estimate(row.estimate, row.low, row.high, row.n, row.method)
    if not cells or part.kind == "share_identical":
        return Row(estimate, [], counts(results, part, cells)[0])
    return Row(estimate, _dots(results, part, cells), None)


def _dots(results: Results, part: Part, cells: tuple[str, ...]) -> list[Dots]:
    """What is measured of each run: of two cells run by run, the difference."""
    known = {cell: by_seed(results, part, cell) for cell in cells}
    if part.kind == "ratio_of_sums":  # a run without any has no share
        runs, (of, per) = known[cells[0]], samples(results, part, cells)
        some = per > 0
        seeds = [int(seed) for seed in np.asarray(runs.index)[some]]
        return [Dots(cells[0], seeds, of[some] / per[some])]
    if part.paired:
        one, other = known.values()
        less = (one - other).dropna()
        return [Dots(cells[0], [int(seed) for seed in less.index], less.to_numpy(float))]
    return [
        Dots(cell, [int(seed) for seed in values.index], values.to_numpy(float))
        for cell, values in known.items()
    ]


def _beside(results: Results, part: Part, cell: str, others: Sequence[str]) -> list[Row]:
    """The same share of other cells of the same task and architecture."""
    alike = cell.rpartition("/")[0]
    return [
        Row(compare(results, part, (other,)), _dots(results, part, (other,)), None, beside=True)
        for other in others
        if other != cell and other.rpartition("/")[0] == alike and other in results.cells
    ]
