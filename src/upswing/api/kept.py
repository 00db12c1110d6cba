"""A study that the history has kept: its tables, without what its runs left behind."""

from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import pandas as pd

from upswing.analysis.history.entry import Listed
from upswing.analysis.history.sides import Side, of_entry
from upswing.api.cell import Cell
from upswing.api.shown import table_of
from upswing.api.study import Study
from upswing.runs.results import Results
from upswing.study.errors import BadInput
from upswing.study.history_paths import RUNS, folder_of
from upswing.study.ids import cell_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from upswing.api.run import Run


class KeptResults(Results):
    """What an entry of the history has in place of a folder of results."""

    def __init__(self, results: Path, entry: Listed) -> None:
        super().__init__(results / folder_of(entry.id))
        self.name = f"{entry.name} of the history in {results}"
        self._of = results, entry

    @cached_property
    def side(self) -> Side:
        """The tables of the entry; ``BadInput`` if one is missing or damaged."""
        results, entry = self._of
        return of_entry(results, entry.id)

    @cached_property
    def runs(self) -> pd.DataFrame:
        """The table of runs with what an entry keeps of each, and a column ``cell``."""
        frame = self.side.runs
        if lacking := [name for name in ("seed", "diverged_at") if name not in frame]:
            path = self.folder / RUNS
            raise BadInput(
                [f"{path}: {lacking[0]}: there is no such column; it is of another origin"]
            )
        return frame.assign(cell=frame["run"].map(cell_of))

    def has_not(self, what: str, instead: str) -> NoReturn:
        """Say that an entry does not keep something; raises ``BadInput``."""
        raise BadInput([f"{self.name}: {what}: an entry keeps tables only; {instead}"])


class KeptCell(Cell):
    """A cell of a study that the history has kept: its rows and estimates, without its runs' files."""

    _results: KeptResults

    def run(self, seed: int) -> "Run":
        """Nothing: the history keeps no trajectories, weights and recordings; raises ``BadInput``."""
        results, _ = self._results._of
        self._results.has_not(
            f"seed-{seed} of {self.id}",
            f"its row stands in `runs`, and what is stored now is in upswing.open({str(results)!r})",
        )

    def plot(self) -> "Figure":
        """Nothing, for the same reason; raises ``BadInput``."""
        self._results.has_not(f"a picture of {self.id}", "`estimate` has what its runs came to")


class KeptStudy(Study):
    """A study as the history has kept it, to be read: ``upswing.open("results", at="@1")``.

    It has the tables of its runs (with what an entry keeps of each), cells, verdicts and evidence, its
    configuration and its cells. What single runs left behind, their steps and what they learned, is not
    kept.

    Attributes:
        entry: the head of the entry: when, by which commit, what was noted, what had changed.
    """

    _results: KeptResults

    def __init__(self, results: Path, entry: Listed) -> None:
        super().__init__(KeptResults(results, entry))
        self.entry = entry

    @property
    def cells(self) -> pd.DataFrame:
        """The table of cells, a row each: measures with their intervals and spreads."""
        found = self._results.side.cells
        assert found is not None  # noqa: S101  an entry is only read with it
        return found.copy()

    @property
    def verdicts(self) -> pd.DataFrame:
        """The table of verdicts, a row for each claim of the thesis."""
        return self._results.side.verdicts.copy()

    @property
    def evidence(self) -> pd.DataFrame:
        """The table of evidence, a row for each comparison that a verdict rests on."""
        return self._results.side.evidence.copy()

    def _cell(self, cell: str) -> Cell:
        return KeptCell(self._results, cell)

    def __repr__(self) -> str:
        counted = f"{self.entry.cells} cells, {self.entry.runs.all:,} runs"
        return f"<study {self._results.name}: {counted}, tables only>"

    def _repr_html_(self) -> str:
        entry = self.entry
        rows: dict[str, Any] = {
            "when": f"{entry.when_shown} UTC",
            "commit": entry.commit_shown,
            "cells": entry.cells,
            "runs": entry.runs.all,
            "verdicts": ", ".join(
                f"{count} {word}" for word, count in _counted([*entry.verdicts.values()])
            ),
            "notes": "; ".join(entry.every_note) or None,
        }
        return table_of(f"Study {self._results.name}", rows)


def _counted(words: list[str]) -> list[tuple[str, int]]:
    return [(word, words.count(word)) for word in dict.fromkeys(words)]
