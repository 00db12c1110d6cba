"""A folder of results, opened: its tables, its cells, its runs."""

from collections.abc import Iterator, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import pandas as pd

from upswing.api.asked import Given, specified
from upswing.api.cell import Cell
from upswing.api.run import Run
from upswing.api.shown import table_of
from upswing.api.training import learned_here
from upswing.runs.files.tables import read_cells, read_evidence, read_verdicts
from upswing.runs.results import Results
from upswing.study.asked_run import FORM
from upswing.study.config import Study as Configuration
from upswing.study.errors import BadInput, near
from upswing.study.ids import named_by
from upswing.study.names import alpha_text
from upswing.study.paths import STUDY, VERDICTS


class Study:
    """A study that has run. It may be gone through, cell by cell.

    Attributes:
        folder: where its results are.
    """

    def __init__(self, results: Results) -> None:
        self._results, self.folder = results, results.folder

    @property
    def configuration(self) -> Configuration:
        """What was asked for: tasks, architectures, experiments, readings."""
        return self._results.study

    @property
    def runs(self) -> pd.DataFrame:
        """The table of runs, a row each, with the id of its cell; ``docs/results.md`` has the columns.

        Raises:
            BadInput: there is none, or runs of the study are missing from it.
        """
        return self._results.runs.copy()

    @property
    def cells(self) -> pd.DataFrame:
        """The table of cells, a row each: measures with their intervals and spreads."""
        return read_cells(self.folder, self._results.cells)

    @property
    def verdicts(self) -> pd.DataFrame:
        """The table of verdicts, a row for each claim of the thesis."""
        return read_verdicts(self.folder)

    @property
    def evidence(self) -> pd.DataFrame:
        """The table of evidence, a row for each comparison that a verdict rests on."""
        return read_evidence(self.folder)

    def cell(
        self,
        cell: str | None = None,
        *,
        task: str | None = None,
        architecture: str | None = None,
        alpha: float | None = None,
    ) -> Cell:
        """A cell by its id, or by as much of task, architecture and α as says which.

        Raises:
            BadInput: there is no such cell, or there are several; it names near ones.
        """
        known = self._results.cells
        given = {"task": task, "architecture": architecture, "alpha": alpha}
        if cell is not None:
            if any(value is not None for value in given.values()):
                raise BadInput([f"cell: {cell}: give an id, or task, architecture and alpha"])
            named = named_by(cell)
            found = cell if named is None else named.cell
            if found not in known:
                raise BadInput([f"{self.folder}: {cell}: no such cell; {near(found, known)[:300]}"])
            return self._cell(found)
        self._check(given)
        matching = [
            name
            for name, spec in known.items()
            if task in (None, spec.task.name)
            and architecture in (None, spec.architecture.name)
            and (alpha is None or alpha_text(spec.alpha) == _alpha(alpha))
        ]
        if len(matching) != 1:
            asked = ", ".join(
                f"{key}={value!r}" for key, value in given.items() if value is not None
            )
            said = f"{len(matching)} cells are that: {', '.join(matching)[:300]}"
            raise BadInput(
                [f"{self.folder}: {asked or 'cell'}: {said if matching else 'no cell is that'}"]
            )
        return self._cell(matching[0])

    def run(self, run: str) -> Run:
        """A run by its id, ``balancing/table/alpha-0.5/seed-10003``, or by the path of a file of it.

        Raises:
            BadInput: there is no such run; it names near ones.
        """
        named = named_by(run)
        if named is None or named.seed is None:
            raise BadInput([f"{self.folder}: {run}: no such run; {FORM}"])
        return self.cell(named.cell).run(named.seed)

    def train(
        self,
        task: Given,
        architecture: Given,
        alpha: float | None = None,
        seed: int = 0,
        steps: int | None = None,
        *,
        epsilon: float | None = None,
        discount: float | None = None,
        readings: Mapping[str, Any] | None = None,
        pendulum: Mapping[str, Any] | None = None,
    ) -> Run:
        """Train a run in this process, by the names and the readings of this study.

        As ``upswing.train``; nothing is written.
        """
        base = self.configuration.model_dump(mode="json")
        return learned_here(
            specified(
                base, task, architecture, alpha, seed, steps, epsilon, discount, readings, pendulum
            )
        )

    def _cell(self, cell: str) -> Cell:
        return Cell(self._results, cell)

    def _check(self, given: Mapping[str, Any]) -> None:
        """Refuse names and step sizes that no cell has."""
        cells = self._results.cells.values()
        known = {
            "task": {spec.task.name for spec in cells},
            "architecture": {spec.architecture.name for spec in cells},
            "alpha": {alpha_text(spec.alpha) for spec in cells},
        }
        problems = []
        for key, value in given.items():
            if value is not None:
                name = _alpha(value) if key == "alpha" else value
                if name not in known[key]:
                    problems.append(
                        f"{self.folder}: {key}: {value}: no cell has it; {near(name, known[key])}"
                    )
        if problems:
            raise BadInput(problems)

    def __iter__(self) -> Iterator[Cell]:
        return (self._cell(cell) for cell in self._results.cells)

    def __len__(self) -> int:
        return len(self._results.cells)

    def __repr__(self) -> str:
        runs = sum(len(spec.seeds) for spec in self._results.cells.values())
        return f"<study in {self.folder}: {len(self)} cells, {runs:,} runs>"

    def _repr_html_(self) -> str:
        configuration = self.configuration
        rows: dict[str, Any] = {
            "cells": len(self),
            "runs": sum(len(spec.seeds) for spec in self._results.cells.values()),
            "tasks": ", ".join(configuration.tasks),
            "architectures": ", ".join(configuration.architectures),
        }
        if (self.folder / VERDICTS).is_file():
            counted = self.verdicts["verdict"].value_counts()
            rows["verdicts"] = ", ".join(f"{count} {verdict}" for verdict, count in counted.items())
        return table_of(f"Study in {self.folder}", rows)


def open(folder: str | PathLike[str] = "results", at: str | None = None) -> Study:
    """The study in a folder of results, or one that its history has kept.

    Args:
        folder: of results: it has a ``study.json``. ``"@1"`` is short for ``at="@1"`` of ``results``.
        at: an entry of the folder's history, as ``upswing history`` calls it: ``@1``, ``@last``, an id
            or its beginning, or a git commit. Of such a study there are the tables only.

    Raises:
        BadInput: it is missing, is no folder of results, or its study cannot be read; or there is no
            such entry.
    """
    place = Path(folder)
    if str(folder).startswith("@") and not place.exists():
        if at is not None:
            raise BadInput([f"open: {folder}: is an entry; name a folder beside at={at!r}"])
        place, at = Path("results"), str(folder)
    if not place.is_dir():
        said = "is a file" if place.exists() else "missing"
        raise BadInput([f"{place}: {said}; it should be a folder of results{_beside(place)}"])
    if at is not None:
        from upswing.analysis.history.read import find
        from upswing.api.kept import KeptStudy

        return KeptStudy(place, find(place, at))
    if not (place / STUDY).is_file():
        right = f"is no folder of results: there is no {STUDY} in it"
        raise BadInput([f"{place}: {right}; `make reproduce` makes one{_beside(place)}"])
    results = Results(place)
    _ = results.study  # what cannot be read is said at once
    return Study(results)


def _alpha(value: Any) -> str:
    """A step size as ids have it; of what is no number its text, which no cell has."""
    try:
        return alpha_text(float(value))
    except (TypeError, ValueError):
        return str(value)


def _beside(place: Path) -> str:
    """Folders of results near a place that is none, in words."""
    near_by = place if place.is_dir() else place.parent
    found = (
        sorted(path.parent.name for path in near_by.glob(f"*/{STUDY}")) if near_by.is_dir() else []
    )
    return f"; in {near_by} there are {', '.join(found[:5])}" if found else ""
