"""Studies held against each other."""

from collections.abc import Sequence
from math import isfinite, isnan
from string import ascii_uppercase
from typing import TYPE_CHECKING

from upswing.cli.terminal import has_room, print_table, say
from upswing.study.wording import listed

if TYPE_CHECKING:
    from upswing.analysis.compare import Comparison, Estimates, Interval, OfACell

SHOWN = 10
"""Largest number of runs that are named of a long list."""

MOST_ROWS = 40
"""Largest number of rows of cells that are printed where not all are asked for."""

STEP = "first stable step"
"""The measure of a cell that is infinite where it never came to that."""

INDENT = 4
"""Of what belongs to the line above [columns]."""


def print_comparison(
    comparison: "Comparison", labels: Sequence[str], places: Sequence[str], everything: bool = False
) -> None:
    """Print what differs between studies: configuration, cells, verdicts, runs.

    Args:
        comparison: what differs.
        labels: how each study was called for.
        places: which one that is.
        everything: whether to name every cell and run.
    """
    letters = list(ascii_uppercase[: len(labels)]) if len(labels) <= 26 else list(labels)
    for letter, label, place in zip(letters, labels, places, strict=True):
        say(f"{letter}: {place if label in place else f'{label}, which is {place}'}", INDENT)
    _configuration(comparison)
    _cells(comparison, letters, None if everything else MOST_ROWS)
    for claim, words in comparison.verdicts:
        say(f"{claim}: {' → '.join(words)}", INDENT)
    if not comparison.verdicts:
        say("every verdict is the same")
    for part in comparison.estimates:
        say(f"{part.claim}: {part.what}: {_estimates(part.values, letters)}", INDENT)
    changed = len(comparison.changed_runs)
    have = "both" if len(labels) == 2 else "all"
    say(f"{changed} of {comparison.common_runs} runs that {have} have are not identical")
    most = None if everything else SHOWN
    _name(comparison.changed_runs, most)
    for there, runs in comparison.partial_runs.items():
        are = "run is" if len(runs) == 1 else "runs are"
        say(f"{len(runs)} {are} only in {_who(there, letters)}")
        _name(runs, most)


def _configuration(comparison: "Comparison") -> None:
    if comparison.configuration is None:
        say("the configurations are not compared: one has no study.json that can be read")
        return
    for row in comparison.configuration:
        say(f"{row.key}: {' → '.join(row.values)}", INDENT)
    if not comparison.configuration:
        say("the configuration is the same")


def _cells(comparison: "Comparison", letters: Sequence[str], most: int | None) -> None:
    if not comparison.cells_known:
        say("the cells are not compared: one has no tables/cells.parquet")
        return
    rows = comparison.cells
    if most is not None and len(rows) > most:
        apart = [row for row in rows if row.parted]  # what matters most, in the order of the study
        rows = sorted((apart or rows)[:most], key=rows.index)
    if rows:
        _side_by_side(rows, letters)
    if more := len(comparison.cells) - len(rows):
        say(f"… and {more} numbers of cells more that differ; --all names them", INDENT)
    if any(row.parted for row in rows):
        say("apart: an estimate lies outside another's interval", INDENT)
    only: dict[tuple[bool, ...], list[str]] = {}
    for cell, there in comparison.partial_cells:
        only.setdefault(there, []).append(cell)
    for there, cells in only.items():
        one = len(cells) == 1
        say(f"{len(cells)} {'cell is' if one else 'cells are'} only in {_who(there, letters)}")
        _name(cells, most and SHOWN)
    differ = len({row.cell for row in comparison.cells})
    all_have = differ + comparison.same_cells
    have = "both" if len(letters) == 2 else "all"
    say(f"{comparison.same_cells} of {all_have} cells that {have} have are the same")


def _side_by_side(rows: "Sequence[OfACell]", letters: Sequence[str]) -> None:
    """A row for each number, with a column for each study; a sentence each where there is no room."""
    header = ("cell", "measure", *letters, "")
    cells = [
        (
            row.cell,
            row.measure,
            *(_of_a_cell(row.measure, value) for value in row.values),
            "apart" if row.parted else "",
        )
        for row in rows
    ]
    if has_room(header, cells):
        print_table(header, cells, right=letters)
        return
    for cell, measure, *numbers, apart in cells:
        told = ", ".join(f"{name} {one}" for name, one in zip(letters, numbers, strict=True))
        say(f"{cell}: {measure}: {told}{' (apart)' if apart else ''}", INDENT)


def _estimates(values: "Estimates", letters: Sequence[str]) -> str:
    """Estimates side by side; who has none is said in words."""
    lacking = [letter for letter, value in zip(letters, values, strict=True) if value is None]
    if not lacking:
        numbers = " → ".join(_short(value.value) for value in values if value is not None)
        return f"{numbers}, outside each other's intervals"
    there = [
        f"{letter} {_number(value)}"
        for letter, value in zip(letters, values, strict=True)
        if value is not None
    ]
    verb = "has" if len(lacking) == 1 else "have"
    return f"{', '.join(there)}; {listed(lacking)} {verb} no estimate of it"


def _number(value: "Interval | None") -> str:
    if value is None:
        return "none"
    middle = _short(value.value)
    if isnan(value.low) or isnan(value.high):
        return middle
    return f"{middle} [{_short(value.low)}, {_short(value.high)}]"


def _of_a_cell(measure: str, value: "Interval | None") -> str:
    """A median that less than half of the runs reached is infinite: it never was."""
    return _number(value).replace("∞", "never") if measure == STEP else _number(value)


def _short(value: float) -> str:
    if not isfinite(value):
        return "∞"
    return f"{value:,.0f}" if abs(value) >= 1_000 else f"{value:.4g}"


def _who(there: Sequence[bool], letters: Sequence[str]) -> str:
    return listed([letter for letter, is_there in zip(letters, there, strict=True) if is_there])


def _name(names: Sequence[str], most: int | None) -> None:
    for name in names[:most]:
        print(f"  {name}")
    if most is not None and len(names) > most:
        print(f"  … and {len(names) - most} more")
