"""What is swept: ``config/readings.yaml`` as a typed value, and the readings that it comes to."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from itertools import combinations, product
from math import prod
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

from pydantic import BeforeValidator, Field, RootModel, ValidationError

from upswing.study.config import Study
from upswing.study.errors import BadInput, explained, near, problem, shown
from upswing.study.known_cells import check_cells
from upswing.study.matrix import Matrix
from upswing.study.names import CellName, Name
from upswing.study.readings import Readings, options_of
from upswing.study.spec import Spec
from upswing.study.values import LARGEST_SEED, Seed, Strict, listed, once
from upswing.study.yaml_file import read_yaml

Cells = Annotated[tuple[CellName, ...], BeforeValidator(listed), once]
Names = Annotated[tuple[str, ...], BeforeValidator(listed), once, Field(min_length=1)]
Pair = Annotated[tuple[str, ...], BeforeValidator(listed), Field(min_length=2, max_length=2)]
MOST_READINGS = 5_000
"""Largest number of readings of a grid; every few of them are a job."""

SELECTION = "selection"
"""The sweep by which the networks' default is chosen."""

CELLS_OF_SELECTION = {
    "p7": "balancing/networks-5/alpha-1",
    "p9": "full-control/networks-30/alpha-1",
    "p11": "full-control/modular-networks-5/alpha-1",
}
"""The cells of figures 7, 9 and 11, which the rule asks."""

Overrides = dict[str, Any]
"""Readings that differ from the study's, by name."""


class Sweep(Strict):
    """Cells of the study, run anew under many readings."""

    vary: Names = Field(description="Names of readings.")
    how: Literal["grid", "pairs"] = Field(
        description="grid: every combination; pairs: the study's, each alone, and two at a time."
    )
    without: Annotated[tuple[Pair, ...], BeforeValidator(listed)] = Field(
        default=(), description="Pairs that cannot touch the same run."
    )
    first_seed: Seed = Field(default=0, description="Seeds are counted from here.")
    seeds: Annotated[int, Field(ge=1, le=1000)] = Field(description="How many.")
    cells: Annotated[Cells, Field(min_length=1)] = Field(description="Ids of cells.")
    cells_of_singles: Cells = Field(
        default=(), description="Costly cells, run when at most one reading differs."
    )


class Sweeps(RootModel[Annotated[dict[Name, Sweep], Field(min_length=1)]]):
    """All sweeps by name."""


class Group(NamedTuple):
    """Readings that share a job."""

    name: str
    members: list[Overrides]


def load_sweeps(path: Path, study: Study) -> Mapping[str, Sweep]:
    """The sweeps written in a YAML file; ``BadInput`` with all its problems otherwise."""
    try:
        sweeps = Sweeps.model_validate(read_yaml(path)).root
    except ValidationError as error:
        raise BadInput(explained(Sweeps, error, lambda _: str(path))) from None
    known, cells = set(Readings.model_fields), Matrix(study).cells
    problems = []
    for name, sweep in sweeps.items():
        for key, words, right in (
            ("vary", sweep.vary, known),
            ("without", [word for pair in sweep.without for word in pair], set(sweep.vary)),
        ):
            problems += [
                f"{path}: {name}.{key}: {shown(word)}: no such reading; {near(word, right)[:200]}"
                for word in words
                if word not in right
            ]
        if sweep.first_seed + sweep.seeds - 1 > LARGEST_SEED:
            beyond = f"with first_seed {sweep.first_seed} the last is beyond {LARGEST_SEED}"
            problems.append(problem(str(path), f"{name}.seeds", sweep.seeds, beyond))
        readings = prod(len(options_of(word)) for word in sweep.vary if word in known)
        if sweep.how == "grid" and readings > MOST_READINGS:
            too_many = f"a grid of these has {readings:,} readings; at most {MOST_READINGS:,}"
            problems.append(problem(str(path), f"{name}.vary", sweep.vary, too_many))
        if twice := sorted(set(sweep.cells) & set(sweep.cells_of_singles)):
            double = "stands in `cells` too; keep one"
            problems.append(problem(str(path), f"{name}.cells_of_singles", twice[0], double))
        if name == SELECTION and (
            lost := sorted(set(CELLS_OF_SELECTION.values()) - set(sweep.cells))
        ):
            needs = f"the rule of selection needs {', '.join(lost)} too"
            problems.append(problem(str(path), f"{name}.cells", sweep.cells, needs))
    if problems:
        raise BadInput(problems)
    check_cells(
        {
            f"{name}.{key}[{number}]": cell
            for name, sweep in sweeps.items()
            for key in ("cells", "cells_of_singles")
            for number, cell in enumerate(getattr(sweep, key))
        },
        study,
        path,
    )
    # A study with fewer cells sweeps fewer.
    return {
        name: sweep
        for name, sweep in sweeps.items()
        if set(sweep.cells) | set(sweep.cells_of_singles) <= set(cells)
    }


def groups(sweep: Sweep, study: Study) -> list[Group]:
    """The readings of a sweep, in jobs of some that differ in the last reading or from it."""
    if sweep.how == "grid":
        *outer, last = sweep.vary
        return [
            Group(_name(chosen) or "all", [{**chosen, last: option} for option in options_of(last)])
            for values in product(*(options_of(name) for name in outer))
            for chosen in [dict(zip(outer, values, strict=True))]
        ]
    singles = [
        {name: option}
        for name in sweep.vary
        for option in options_of(name)
        if option != getattr(study.readings, name)
    ]
    excluded = {frozenset(pair) for pair in sweep.without}
    pairs = [
        {**one, **other}
        for one, other in combinations(singles, 2)
        if len({*one, *other}) == 2 and frozenset({*one, *other}) not in excluded
    ]
    made = [Group("as-the-study", [{}, *singles])]
    for single in singles:
        own = [pair for pair in pairs if next(iter(pair.items())) == next(iter(single.items()))]
        if own:
            made.append(Group(_name(single), own))
    return made


def specs(sweep: Sweep, study: Study, overrides: Overrides) -> Iterator[Spec]:
    """The cells of a sweep under a reading, each with all its seeds."""
    cells = Matrix(study).cells
    readings = study.readings.model_copy(update=overrides)
    seeds = tuple(range(sweep.first_seed, sweep.first_seed + sweep.seeds))
    chosen = (*sweep.cells, *(sweep.cells_of_singles if len(overrides) <= 1 else ()))
    for cell in chosen:
        yield cells[cell].model_copy(update={"readings": readings, "seeds": seeds})


def content_of(sweep: Sweep, study: Study, group: Group, cells: Mapping[str, Spec]) -> str:
    """A checksum of everything that a job's result depends on, besides the code.

    ``cells`` are those of the study, which the workflow has already.
    """
    # In a grid every varied reading is said by the group; in pairs it is the study's where it is not.
    said = {name: options_of(name)[0] for name in sweep.vary} if sweep.how == "grid" else {}
    update = {
        "readings": study.readings.model_copy(update=said),
        "seeds": tuple(range(sweep.first_seed, sweep.first_seed + sweep.seeds)),
    }
    texts = [
        cells[cell].model_copy(update=update).canonical()
        for cell in (*sweep.cells, *sweep.cells_of_singles)
    ]
    texts += [canonical_of(member) for member in group.members]
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]


def number_of(reading: str) -> str:
    """The number of a reading: ``R11``."""
    extra = Readings.model_fields[reading].json_schema_extra
    return str(extra["reading"]) if isinstance(extra, dict) else reading


def label(overrides: Overrides) -> str:
    """Readings in short: ``R10 hidden, R12 0.3``."""
    words = (f"{number_of(name)} {_text(value)}" for name, value in overrides.items())
    return ", ".join(words) or "as the study"


def canonical_of(overrides: Overrides) -> str:
    """Readings as one line: the same text for the same meaning."""
    return json.dumps(overrides, sort_keys=True, separators=(",", ":"))


def _name(overrides: Overrides) -> str:
    return "_".join(f"{number_of(name)}-{_text(value)}" for name, value in overrides.items())


def _text(value: Any) -> str:
    return f"{value:g}" if isinstance(value, float | int) else str(value)
