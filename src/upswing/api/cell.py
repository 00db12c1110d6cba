"""A cell: all runs of a task, an architecture and a step size; estimates of them with intervals."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import pandas as pd

from upswing.analysis import statistics
from upswing.analysis.statistics import LOCATIONS, Estimate
from upswing.api.run import Run, StoredRun
from upswing.api.shown import table_of
from upswing.runs.results import Results
from upswing.study.errors import BadInput, near
from upswing.study.ids import seed_of
from upswing.study.spec import Spec
from upswing.study.task import NamedTask

if TYPE_CHECKING:
    from matplotlib.figure import Figure

NO_MEASURES = ("alpha", "seed", "dirty")
"""Numbers in the table of runs that say which run it is."""


class Cell:
    """All runs of a cell. It may be gone through, run by run, in the order of their seeds.

    Attributes:
        id: which cell it is: ``balancing/table/alpha-0.5``.
        spec: what its runs are made from, with all their seeds.
    """

    def __init__(self, results: Results, cell: str) -> None:
        self._results, self.id = results, cell
        self.spec: Spec = results.cells[cell]

    @property
    def task(self) -> NamedTask:
        """Its task, with its length and how it is judged."""
        return self.spec.task

    @property
    def architecture(self) -> str:
        """The name of its architecture."""
        return self.spec.architecture.name

    @property
    def alpha(self) -> float | None:
        """Its step size α; None for a control."""
        return self.spec.alpha

    @property
    def seeds(self) -> tuple[int, ...]:
        """The seeds of its runs."""
        return self.spec.seeds

    @property
    def runs(self) -> pd.DataFrame:
        """The rows of its runs in the table of runs; ``docs/results.md`` describes the columns."""
        return self._results.cell(self.id).copy()

    def run(self, seed: int) -> Run:
        """Its run with this seed.

        Raises:
            BadInput: there is none; it says which there are.
        """
        if seed not in self.seeds:
            known = f"it has {len(self.seeds)}, from {self.seeds[0]} to {self.seeds[-1]}"
            raise BadInput([f"{self.id}: seed: {seed}: no such run; {known}"])
        return StoredRun(self._results.folder, self.spec.of_seed(int(seed)))

    def estimate(self, measure: str, of: str = "mean") -> Estimate:
        """A measure over the runs: ``value``, 95 % interval ``low`` to ``high``, ``n``, ``method``.

        As in the study's tables: bootstrap, percentiles; runs that diverged do not count, nor those
        that have no such number.

        Args:
            measure: a column of numbers of the table of runs: ``falls``, ``upright_share`` ….
            of: ``mean``, ``median`` or ``interquartile_mean``.

        Raises:
            BadInput: there is no such measure, or no such middle.
        """
        if of not in LOCATIONS:
            raise BadInput([f"estimate: of: {of}: {near(of, LOCATIONS)}"])
        return LOCATIONS[of](self._values(measure).dropna().to_numpy(float))

    def share(self, holds: "pd.Series[bool]") -> Estimate:
        """The share of runs for which something holds, with Wilson's 95 % interval.

        Args:
            holds: true or false for the rows of ``runs``: ``cell.runs["falls_last_fifth"] == 0``. Runs
                that diverged do not count.
        """
        counted = holds.reindex(self._results.counted(self.id).index)
        if counted.isna().any():
            raise BadInput([f"share: must be of the rows of {self.id}: made from its `runs`"])
        return statistics.share(int(counted.astype(bool).sum()), len(counted))

    @property
    def worst(self) -> Run:
        """The first run in the order of the task, the worst first."""
        return self._of_three(0)

    @property
    def median(self) -> Run:
        """The run in the middle of this order; of an even number, the worse of the two."""
        return self._of_three(1)

    @property
    def best(self) -> Run:
        """The last run of this order."""
        return self._of_three(2)

    def plot(self) -> "Figure":
        """φ of the median run, and how all runs learned."""
        from upswing.api.plot import figure_of_cell

        return figure_of_cell(self._results, self.id)

    def _of_three(self, place: int) -> Run:
        return self.run(seed_of(self._results.three_of(self.id)["run"].iloc[place]))

    def _values(self, measure: str) -> "pd.Series[float]":
        rows = self._results.counted(self.id)
        numbers = [
            str(name)
            for name in rows
            if pd.api.types.is_numeric_dtype(rows[name]) and name not in NO_MEASURES
        ]
        if measure not in numbers:
            raise BadInput(
                [f"estimate: measure: {measure}: no such measure; {near(measure, numbers)}"]
            )
        return rows[measure]

    def __iter__(self) -> Iterator[Run]:
        return (self.run(seed) for seed in self.seeds)

    def __len__(self) -> int:
        return len(self.seeds)

    def __repr__(self) -> str:
        return f"<cell {self.id}: {len(self)} runs of {self.task.steps:,} steps>"

    def _repr_html_(self) -> str:
        rows: dict[str, object] = {"runs": len(self), "steps": self.task.steps}
        for measure in (*self.task.first_measures, "greedy_success_share"):
            found = self.estimate(measure)
            rows[measure] = f"{found.value:.4g}  ({found.low:.4g} to {found.high:.4g})"
        return table_of(f"{self.id}: means, with 95 % intervals", rows)
