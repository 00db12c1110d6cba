"""Studies held against each other (commits, machines, edits): what is asked, and what came out."""

from collections.abc import Callable, Sequence
from math import isfinite
from typing import TYPE_CHECKING, Any, NamedTuple

from upswing.analysis.history.configuration import Difference, differences, union
from upswing.analysis.history.sides import TIMED, Side, rounded

if TYPE_CHECKING:
    import pandas as pd

NONE = "none"
"""The verdict of a study that does not have the claim."""


class Interval(NamedTuple):
    """A number with its interval; without one, NaN at both ends."""

    value: float
    low: float
    high: float

    def parted_from(self, other: "Interval") -> bool:
        """Whether one lies outside the other's interval, either way round."""
        return (
            self.value < other.low
            or self.value > other.high
            or other.value < self.low
            or other.value > self.high
        )


Estimates = tuple[Interval | None, ...]
"""One for each study; None where it has none."""


class OfACell(NamedTuple):
    """A measure of a cell that is not the same everywhere."""

    cell: str
    measure: str
    values: Estimates

    @property
    def parted(self) -> bool:
        """Whether two of them lie outside each other's intervals."""
        return _parted(self.values)


class OfAPart(NamedTuple):
    """A comparison that a claim rests on whose estimates lie apart, or that not all studies have."""

    claim: str
    what: str
    values: Estimates


class Comparison(NamedTuple):
    """What differs between studies, each with a value for every one of them, in their order."""

    configuration: list[Difference] | None  # None where that of one is not known
    cells: list[OfACell]
    same_cells: int
    partial_cells: list[tuple[str, tuple[bool, ...]]]  # cells that not all have: which do
    cells_known: bool
    verdicts: list[tuple[str, tuple[str, ...]]]  # claim, and its verdicts
    estimates: list[OfAPart]
    changed_runs: list[str]  # runs of all that are not identical
    common_runs: int
    partial_runs: dict[tuple[bool, ...], list[str]]  # by which studies have them


COMPARED = {
    "falls": "falls_mean",
    "falls in the last fifth": "falls_last_fifth_mean",
    "upright share": "upright_share_mean",
    "upright at the end": "upright_at_end_mean",
    "above the horizontal": "above_horizontal_share_mean",
    "mean reward [rad²]": "mean_reward_mean",
    "first stable step": "first_stable_step_median",
    "frozen success share": "frozen_success_share",
    "runs": "runs",
    "runs diverged": "runs_diverged",
    "runs stable": "runs_stable",
    "runs kept": "runs_kept",
}
"""What is shown of a cell that differs, by its name for readers: the column of its estimate."""

ENDS = {"first_stable_step_median": ("first_stable_step_low", "first_stable_step_high")}
"""Where an interval's columns are not named after the estimate's."""


def compare(sides: Sequence[Side]) -> Comparison:
    """What differs between studies.

    A verdict that only some have counts as changed. An estimate has parted if it lies outside another's
    interval, either way round, or if only some have it.
    """
    configurations = [side.configuration for side in sides]
    known = [each for each in configurations if each is not None]
    runs = [dict(zip(side.runs["run"], side.runs["digest"], strict=True)) for side in sides]
    common, partial = _presence(runs)
    cells, same, partial_cells = _cells(sides)
    verdicts = [dict(zip(s.verdicts["claim"], s.verdicts["verdict"], strict=True)) for s in sides]
    judged = [
        (claim, tuple(str(own.get(claim, NONE)) for own in verdicts)) for claim in union(verdicts)
    ]
    return Comparison(
        configuration=differences(known) if len(known) == len(sides) else None,
        cells=cells,
        same_cells=same,
        partial_cells=partial_cells,
        cells_known=all(side.cells is not None for side in sides),
        verdicts=[(claim, words) for claim, words in judged if len(set(words)) > 1],
        estimates=_estimates(sides),
        changed_runs=[run for run in common if len({own[run] for own in runs}) > 1],
        common_runs=len(common),
        partial_runs=partial,
    )


def _presence(
    mappings: Sequence[dict[str, Any]],
) -> tuple[list[str], dict[tuple[bool, ...], list[str]]]:
    """The names that all have; and the others, by who has them."""
    common: list[str] = []
    partial: dict[tuple[bool, ...], list[str]] = {}
    for name in union(mappings):
        there = tuple(name in mapping for mapping in mappings)
        if all(there):
            common.append(name)
        else:
            partial.setdefault(there, []).append(name)
    return common, partial


def _cells(
    sides: Sequence[Side],
) -> tuple[list[OfACell], int, list[tuple[str, tuple[bool, ...]]]]:
    """What differs in cells that all have, how many are the same, and those that not all have."""
    tables = [side.cells for side in sides if side.cells is not None]
    if len(tables) < len(sides):
        return [], 0, []
    shared = [str(name) for name in tables[0] if all(name in table for table in tables)]
    texts = [dict(zip(table["cell"], rounded(table[shared]), strict=True)) for table in tables]
    rows = [_by(table, "cell") for table in tables]
    common, partial = _presence(texts)
    found: list[OfACell] = []
    same = 0
    for cell in common:
        if all(own[cell] == texts[0][cell] for own in texts):
            same += 1
            continue
        for words, column in COMPARED.items():
            if column in shared and len({own[cell][column] for own in texts}) > 1:
                found.append(OfACell(cell, words, _values(rows, cell, column)))
        if not found or found[-1].cell != cell:
            other = next(
                name for name in shared
                if name not in TIMED and len({own[cell][name] for own in texts}) > 1
            )  # fmt: skip
            found.append(OfACell(cell, other, _values(rows, cell, other)))
    return found, same, [(cell, there) for there, own in partial.items() for cell in own]


def _values(rows: Sequence[dict[Any, dict[str, Any]]], cell: str, column: str) -> Estimates:
    low, high = ENDS.get(column, (f"{column}_low", f"{column}_high"))
    return tuple(_estimate(row[cell].get, column, low, high) for row in rows)


def _estimate(get: Callable[[str], Any], value: str, low: str, high: str) -> Interval | None:
    """An estimate of a row; None where there is none."""
    numbers = [get(name) for name in (value, low, high)]
    if not _is_number(numbers[0]):
        return None
    return Interval(*(float(one) if _is_number(one) else float("nan") for one in numbers))


def _is_number(value: Any) -> bool:
    try:
        return (not isinstance(value, str) and isfinite(value)) or value == float("inf")
    except TypeError:
        return False


def _by(frame: "pd.DataFrame", *key: str) -> dict[Any, dict[str, Any]]:
    return {
        row[key[0]] if len(key) == 1 else tuple(row[name] for name in key): row
        for row in ({str(name): one for name, one in r.items()} for r in frame.to_dict("records"))
    }


def _estimates(sides: Sequence[Side]) -> list[OfAPart]:
    """The comparisons whose estimates lie apart, or that only some studies have."""
    tables = [_by(side.evidence, "claim", "part", "cells") for side in sides]
    found = []
    for key in dict.fromkeys(key for table in tables for key in table):
        values = tuple(
            _estimate(table[key].get, "estimate", "low", "high") if key in table else None
            for table in tables
        )
        there = [value is not None for value in values]
        if (any(there) and not all(there)) or _parted(values):
            claim, part, cells = key
            found.append(OfAPart(str(claim), f"part {part}, {cells}", values))
    return found


def _parted(values: Estimates) -> bool:
    known = [value for value in values if value is not None]
    return any(one.parted_from(other) for at, one in enumerate(known) for other in known[:at])
