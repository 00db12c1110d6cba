"""Reading a folder of results: the runs of a cell, their windows, the worst, median and best run."""

from collections.abc import Collection, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from upswing.runs.adopted import joined
from upswing.runs.files.tables import read_runs
from upswing.runs.files.trajectory import OF_A_TRAJECTORY, OF_WINDOWS
from upswing.runs.files.typed_table import read_table
from upswing.runs.rows import collected
from upswing.runs.study_file import read_study
from upswing.study.config import Study
from upswing.study.errors import BadInput
from upswing.study.ids import cell_of, file_of
from upswing.study.paths import RUNS, TILES
from upswing.study.spec import Spec
from upswing.study.task import NamedTask

Real = NDArray[np.float64]

TRAJECTORY, WINDOWS = "trajectory.parquet", "windows.parquet"
COLUMNS_OF = {TRAJECTORY: OF_A_TRAJECTORY, WINDOWS: OF_WINDOWS}


class OneRun(NamedTuple):
    """A single run of a cell."""

    id: str
    task: NamedTask
    seed: int
    trajectory: pd.DataFrame  # stored steps: whole at the start and end, thinned between
    windows: pd.DataFrame  # the whole run in windows


class Ensemble(NamedTuple):
    """All runs of a cell, by window; arrays of shape (runs, windows)."""

    task: NamedTask
    seeds: list[int]
    last_step: Real  # after which step a window ends: (windows,)
    falls: Real
    upright_share: Real
    diverged: NDArray[np.bool_]  # which runs diverged: (runs,); NaN from the window of it on

    @property
    def falls_so_far(self) -> Real:
        """Falls since the beginning, shape (runs, windows)."""
        return np.cumsum(self.falls, axis=1)


class Results:
    """A folder of results, read for drawing.

    Args:
        folder: the folder.
        study: the study that is asked for; without, the one that the folder is of.
    """

    def __init__(self, folder: Path, study: Study | None = None) -> None:
        self.folder = folder
        if study is not None:
            self.__dict__["study"] = study

    @cached_property
    def study(self) -> Study:
        """The study that these are the results of."""
        return read_study(self.folder)

    @cached_property
    def cells(self) -> Mapping[str, Spec]:
        """The cells of the study by their ids, and behind them those that were adopted."""
        return joined(self.folder, self.study).cells

    @property
    def architectures(self) -> list[str]:
        """The names of the architectures of its cells."""
        return list(dict.fromkeys(spec.architecture.name for spec in self.cells.values()))

    @cached_property
    def runs(self) -> pd.DataFrame:
        """The table of runs, with a column ``cell``; ``BadInput`` if a run of the study is missing."""
        path, cells = self.folder / RUNS, self.cells
        known = {spec.run(seed) for spec in cells.values() for seed in spec.seeds}
        frame = read_runs(self.folder, known)
        frame["cell"] = frame["run"].map(cell_of)
        there = frame.groupby("cell")["seed"].agg(set).to_dict()
        if incomplete := [
            f"{path}: {cell}: {len(lost)} of {len(spec.seeds)} runs are missing; "
            f"run the study again to make them"
            for cell, spec in cells.items()
            if (lost := set(spec.seeds) - there.get(cell, set()))
        ]:
            raise BadInput(incomplete)
        return frame

    @cached_property
    def tile_policy(self) -> pd.DataFrame:
        """What a policy on the thesis's tiles came to, a row for each start."""
        remedy = f"`upswing tiles {self.folder}` makes it"
        return read_table(self.folder / TILES, {"angle": "number", "success": "truth"}, remedy)

    def check_complete(self, cells: Collection[str]) -> None:
        """Raise ``BadInput`` if a run of ``cells``, or what shows it, is missing; it names the cells."""
        problems = []
        for cell in (cell for cell in self.cells if cell in cells):
            recordings = [self.folder / path for path in self.cell(cell)["recording"]]
            if lost := [path for path in recordings if not path.is_file()]:
                problems.append(
                    f"{self.folder}: {cell}: {len(lost)} of {len(recordings)} recordings are missing "
                    f"({lost[0].name}, …); run the study again to make them"
                )
        if problems:
            raise BadInput(problems)

    def cell(self, cell: str) -> pd.DataFrame:
        """The rows of a cell's runs."""
        if cell not in self.cells:
            raise BadInput([f"{self.folder}: {cell}: no cell of this study"])
        return self.runs[self.runs["cell"] == cell]

    def counted(self, cell: str) -> pd.DataFrame:
        """The rows of a cell's runs that count: those whose values stayed finite."""
        runs = self.cell(cell)
        return runs[runs["diverged_at"].isna()]

    def task(self, cell: str) -> NamedTask:
        """The task of a cell."""
        return self.cells[cell].task

    def in_order(self, cell: str) -> pd.DataFrame:
        """The rows of a cell's runs, the worst first; of those that count, unless all diverged."""
        order = self.task(cell).order_of_runs
        counted = self.counted(cell)
        runs = counted if len(counted) else self.cell(cell)
        self.check_measures(runs, list(order))
        return runs.sort_values(list(order), ascending=list(order.values()))

    def check_measures(self, runs: pd.DataFrame, measures: Sequence[str]) -> None:
        """Raise ``BadInput`` if rows of the table of runs lack a measure, or if one is no number."""
        for name in measures:
            if name not in runs or not pd.api.types.is_numeric_dtype(runs[name]):
                raise BadInput(
                    [
                        f"{self.folder / RUNS}: {name}: there is no such column of numbers; "
                        f"`upswing tables {self.folder}` makes the table anew"
                    ]
                )

    def median_run(self, cell: str) -> OneRun:
        """The run in the middle of a cell; of an even number, the worse of the two in the middle."""
        return self._one(cell, self.three_of(cell).iloc[1])

    def worst_median_best(self, cell: str) -> list[OneRun]:
        """The first, the middle and the last run of a cell, in the order of its runs."""
        return [self._one(cell, row) for _, row in self.three_of(cell).iterrows()]

    def three_of(self, cell: str) -> pd.DataFrame:
        """The rows of the worst, the median and the best run of a cell."""
        ordered = self.in_order(cell)
        return ordered.iloc[[0, (len(ordered) - 1) // 2, len(ordered) - 1]]

    def _one(self, cell: str, row: pd.Series) -> OneRun:
        return OneRun(
            row["run"],
            self.task(cell),
            int(row["seed"]),
            self.trajectory(row["run"]),
            self._read(row["run"], WINDOWS),
        )

    def trajectory(self, run: str) -> pd.DataFrame:
        """The stored steps of a run."""
        return self._read(run, TRAJECTORY)

    def ensemble(self, cell: str) -> Ensemble:
        """All runs of a cell."""
        rows = self.cell(cell)
        windows = [self._read(run, WINDOWS) for run in rows["run"]]
        last_step = (windows[0]["first_step"] + windows[0]["steps"]).to_numpy(float)
        diverged_at = rows["diverged_at"].to_numpy(float, na_value=np.inf)
        meaningful = last_step <= diverged_at[:, None]
        falls, upright_share = (
            np.where(
                meaningful, np.stack([frame[name].to_numpy(float) for frame in windows]), np.nan
            )
            for name in ("falls", "upright_share")
        )
        return Ensemble(
            task=self.task(cell),
            seeds=[int(seed) for seed in rows["seed"]],
            last_step=last_step,
            falls=falls,
            upright_share=upright_share,
            diverged=np.isfinite(diverged_at),
        )

    def _read(self, run: str, file: str) -> pd.DataFrame:
        path = self.folder / file_of(run, file)
        return read_table(path, COLUMNS_OF[file], "run the study again to make it")


class OwnRuns(Results):
    """Results of which only some cells are read, from their own runs' files and not from the tables.

    So what is made of them depends on these cells and on nothing else.
    """

    def cell(self, cell: str) -> pd.DataFrame:
        """The rows of a cell's runs."""
        if cell not in self.cells:
            raise BadInput([f"{self.folder}: {cell}: no cell of this study"])
        if cell not in self._read_cells:
            rows = collected(self.folder, [self.cells[cell]])
            if "diverged_at" not in rows:
                older = "its runs are of an older version; run the study again to make them"
                raise BadInput([f"{self.folder}: {cell}: {older}"])
            self._read_cells[cell] = rows.assign(cell=cell)
        return self._read_cells[cell]

    @cached_property
    def _read_cells(self) -> dict[str, pd.DataFrame]:
        return {}
