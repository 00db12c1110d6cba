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

CHOOSING = "networks"
"""The sweep by which the networks' default is chosen."""

SEEDS_OF_A_JOB = 24
"""Number of seeds that a job of a later round runs."""

Overrides = dict[str, Any]
"""Readings that differ from the study's, by name."""


class Report(Strict):
    """Something that the author reports of a run, by which readings are weighed."""

    figure: Annotated[int, Field(ge=5, le=11)] = Field(description="The figure that shows it.")
    cell: CellName = Field(description="The cell that the figure is of.")
    shows: Literal["success", "failure", "both"] = Field(
        description="Whether its run succeeds, fails, or some runs do and some do not."
    )


class Round(Strict):
    """A round of successive halving: the likeliest readings go on, with more seeds."""

    readings: Annotated[int, Field(ge=1)] = Field(description="How many readings go on.")
    seeds: Annotated[int, Field(ge=1, le=10_000)] = Field(
        description="How many seeds each has then, those of the rounds before included."
    )


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
    every: dict[CellName, Annotated[int, Field(ge=1)]] = Field(
        default_factory=dict, description="Of a costly cell every so-many-th seed is run."
    )
    beside: Cells = Field(
        default=(), description="Cells that no varied reading touches: run once, as in the study."
    )
    seeds_beside: Annotated[int, Field(ge=1, le=1000)] = Field(
        default=1, description="How many seeds they have."
    )
    reports: dict[Name, Report] = Field(
        default_factory=dict,
        description="What the author reports; it says how likely a reading is.",
    )
    rounds: Annotated[tuple[Round, ...], BeforeValidator(listed)] = Field(
        default=(), description="Rounds in which the likeliest readings get more seeds."
    )
    cells_of_rounds: Cells = Field(
        default=(), description="Costly cells, run for the readings that go on only."
    )

    @property
    def every_cell(self) -> tuple[str, ...]:
        """All cells that are run under some reading."""
        return (*self.cells, *self.cells_of_singles, *self.cells_of_rounds, *self.beside)

    @property
    def last_seed(self) -> int:
        """The largest seed of any round."""
        counts = (self.seeds, self.seeds_beside, *(one.seeds for one in self.rounds))
        return self.first_seed + max(counts) - 1


class Sweeps(RootModel[Annotated[dict[Name, Sweep], Field(min_length=1)]]):
    """All sweeps by name."""


class Group(NamedTuple):
    """Readings that share a job."""

    name: str
    members: list[Overrides]  # none where those are meant that go on to a later round
    seeds: range
    cells: tuple[str, ...]
    cells_of_singles: tuple[str, ...] = ()
    round: int = 1


def load_sweeps(path: Path, study: Study) -> Mapping[str, Sweep]:
    """The sweeps written in a YAML file; ``BadInput`` with all its problems otherwise."""
    try:
        sweeps = Sweeps.model_validate(read_yaml(path)).root
    except ValidationError as error:
        raise BadInput(explained(Sweeps, error, lambda *_: str(path))) from None
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
        if sweep.last_seed > LARGEST_SEED:
            beyond = f"with first_seed {sweep.first_seed} the last is beyond {LARGEST_SEED}"
            problems.append(problem(str(path), f"{name}.seeds", sweep.seeds, beyond))
        readings = prod(len(options_of(word)) for word in sweep.vary if word in known)
        if sweep.how == "grid" and readings > MOST_READINGS:
            too_many = f"a grid of these has {readings:,} readings; at most {MOST_READINGS:,}"
            problems.append(problem(str(path), f"{name}.vary", sweep.vary, too_many))
        if twice := sorted(set(sweep.cells) & set(sweep.cells_of_singles)):
            double = "stands in `cells` too; keep one"
            problems.append(problem(str(path), f"{name}.cells_of_singles", twice[0], double))
        problems += [
            problem(str(path), f"{name}.{place}", cell, "is run by no round; name it in `cells`")
            for place, cell, known_here in (
                *((f"reports.{key}", one.cell, sweep.cells) for key, one in sweep.reports.items()),
                *(("every", cell, (*sweep.cells, *sweep.cells_of_rounds)) for cell in sweep.every),
            )
            if cell not in known_here
        ]
        if sweep.rounds and not sweep.reports:
            problems.append(
                f"{path}: {name}.reports: missing: rounds need them to say which readings go on"
            )
        counts = [sweep.seeds, *(one.seeds for one in sweep.rounds)]
        if counts != sorted(set(counts)):
            more = "each round has more seeds than the one before"
            problems.append(problem(str(path), f"{name}.rounds", counts, more))
    if problems:
        raise BadInput(problems)
    check_cells(
        {
            f"{name}.{key}[{number}]": cell
            for name, sweep in sweeps.items()
            for key in ("cells", "cells_of_singles", "cells_of_rounds", "beside")
            for number, cell in enumerate(getattr(sweep, key))
        },
        study,
        path,
    )
    # A study with fewer cells sweeps fewer.
    return {name: sweep for name, sweep in sweeps.items() if set(sweep.every_cell) <= set(cells)}


def groups(sweep: Sweep, study: Study) -> list[Group]:
    """The jobs of a sweep: its readings in groups, what is run once, and the later rounds."""
    seeds = range(sweep.first_seed, sweep.first_seed + sweep.seeds)
    made = [
        Group(name, members, seeds, sweep.cells, sweep.cells_of_singles)
        for name, members in _readings(sweep, study)
    ]
    if sweep.beside:
        once_only = range(sweep.first_seed, sweep.first_seed + sweep.seeds_beside)
        made.append(Group("beside", [{}], once_only, sweep.beside))
    cells = (*sweep.cells, *sweep.cells_of_rounds)
    start = sweep.seeds
    for number, one in enumerate(sweep.rounds, 2):
        for first in range(start, one.seeds, SEEDS_OF_A_JOB):
            last = min(first + SEEDS_OF_A_JOB, one.seeds)
            own = range(sweep.first_seed + first, sweep.first_seed + last)
            name = f"round-{number}_seeds-{own[0]}-to-{own[-1]}"
            made.append(Group(name, [], own, cells, round=number))
        start = one.seeds
    return made


def readings_of(sweep: Sweep, study: Study) -> list[Overrides]:
    """Every reading of a sweep."""
    return [member for _, members in _readings(sweep, study) for member in members]


def _readings(sweep: Sweep, study: Study) -> list[tuple[str, list[Overrides]]]:
    """The readings of a sweep, in groups of some that differ in the last reading or from it."""
    if sweep.how == "grid":
        *outer, last = sweep.vary
        return [
            (_name(chosen) or "all", [{**chosen, last: option} for option in options_of(last)])
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
    made = [("as-the-study", [{}, *singles])]
    for single in singles:
        own = [pair for pair in pairs if next(iter(pair.items())) == next(iter(single.items()))]
        if own:
            made.append((_name(single), own))
    return made


def specs(
    sweep: Sweep, study: Study, overrides: Overrides, group: Group | None = None
) -> Iterator[Spec]:
    """The cells of a sweep, or of a group of it, under a reading, each with its seeds."""
    cells = Matrix(study).cells
    readings = study.readings.model_copy(update=overrides)
    if group is None:
        seeds = range(sweep.first_seed, sweep.first_seed + sweep.seeds)
        group = Group("", [], seeds, (*sweep.cells, *sweep.cells_of_rounds), sweep.cells_of_singles)
    chosen = (*group.cells, *(group.cells_of_singles if len(overrides) <= 1 else ()))
    for cell in chosen:
        every = sweep.every.get(cell, 1)
        seeds_of_cell = tuple(s for s in group.seeds if (s - sweep.first_seed) % every == 0)
        if seeds_of_cell:
            yield cells[cell].model_copy(update={"readings": readings, "seeds": seeds_of_cell})


def content_of(sweep: Sweep, study: Study, group: Group, cells: Mapping[str, Spec]) -> str:
    """A checksum of everything that a job's result depends on, besides the code.

    ``cells`` are those of the study, which the workflow has already.
    """
    # In a grid every varied reading is said by the group; in pairs it is the study's where it is not.
    is_said = sweep.how == "grid" and group.members != [{}]
    said = {name: options_of(name)[0] for name in sweep.vary} if is_said else {}
    update = {"readings": study.readings.model_copy(update=said), "seeds": tuple(group.seeds)}
    texts = [
        f"{cells[cell].model_copy(update=update).canonical()} {sweep.every.get(cell, 1)}"
        for cell in (*group.cells, *group.cells_of_singles)
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
