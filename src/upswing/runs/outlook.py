"""What a study's folder holds of its runs, and about how long and how large what is missing will be."""

import json
import os
from functools import cached_property
from math import log
from pathlib import Path
from typing import NamedTuple

from upswing.runs.files.ledger import Ledger, ledger_of_run, ledger_path, read_ledger
from upswing.runs.job_costs import job_cost
from upswing.study.code import training
from upswing.study.errors import BadInput
from upswing.study.ids import RUN_FILES, file_of
from upswing.study.matrix import Block, Matrix
from upswing.study.paths import JOB_COSTS
from upswing.study.spec import Spec

START = 1.0
"""What a job of training takes to begin [s of processor time]. This and the next as measured on two
cores of a laptop's kind; where the folder has jobs of its own, these correct it."""

OF_A_RUN = 0.03
"""What a run takes besides its steps: measures, greedy evaluation, files [s]."""

OF_A_STEP = {
    "control": 6e-8, "table": 6e-8, "decaying": 8e-8, "gated": 1.2e-7, "networks": 1.5e-7,
    "action-input": 1.2e-6, "dqn": 6e-5, "dqn-sb3": 1.6e-4,
}  # fmt: skip
"""What a step takes, by learner [s]."""

OF_A_STEP_OF_NETWORKS_ELSEWHERE = 1.5e-6
"""The same of networks on an encoder without a table of what each tile gives [s]."""

FOLLOWS, FOLLOWS_A_RUN = 25.0, 0.015
"""What follows training, tables, figures and page: at least, and for each run [s]."""

WALL = 1.3
"""Time by the clock for a second of processor time: files are written, and jobs wait for one another."""

LARGEST, SMALLEST = 650_000, 180_000
"""A run's four files from 20,000 steps on, and at 100 steps [bytes]."""

SAMPLED = 3
"""Number of a cell's runs whose files are looked at for how large they are."""


class Outlook(NamedTuple):
    """What is there, and what is to come."""

    runs: int
    there: int  # as they are asked for
    anew: int  # there, but of another configuration or of other code
    seconds: float  # until all is made, on this machine's processors
    processors: int
    megabytes: float  # that all runs of the study take then
    measured: bool  # by what the folder's own jobs took

    @property
    def to_train(self) -> int:
        """Number of runs that are to be trained, for the first time or anew."""
        return self.runs - self.there


def outlook(matrix: Matrix, results: Path) -> Outlook:
    """What a folder holds of a study, without reading more than one small file of each job."""
    folder = _Folder(matrix, results)
    there = anew = 0
    cpu = 0.0
    size = 0.0
    for cell, spec in matrix.cells.items():
        size += folder.bytes_of_a_run(spec) * len(spec.seeds)
        for block in matrix.blocks_of(spec):
            exist = folder.exist(spec, block)
            if all(exist) and folder.is_as_asked(spec, block):
                there += len(block.seeds)
            else:
                anew += sum(exist) if all(exist) else 0
                cpu += folder.cpu_seconds(cell, spec, block)
    runs = sum(len(spec.seeds) for spec in matrix.cells.values())
    processors = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else 1
    follows = folder.seconds_that_follow if there < runs else 0.0
    return Outlook(
        runs=runs,
        there=there,
        anew=anew,
        seconds=(WALL * cpu + follows) / processors,
        processors=processors,
        megabytes=size / 1e6,
        measured=bool(folder.measured),
    )


class _Folder:
    """What is known of a folder of results, asked once."""

    def __init__(self, matrix: Matrix, results: Path) -> None:
        self._matrix = matrix
        self._results = results
        self._names: dict[str, set[str]] = {}
        self._ledgers: dict[str, Ledger | None] = {}

    def exist(self, spec: Spec, block: Block) -> list[bool]:
        """Of each run of a job whether all its files are there."""
        names = self._there(spec)
        return [
            all(file_of(spec.run(seed), kind).rpartition("/")[2] in names for kind in RUN_FILES)
            for seed in block.seeds
        ]

    def is_as_asked(self, spec: Spec, block: Block) -> bool:
        """Whether a job's first run was made from what is asked now; its ledger says so."""
        first = block.seeds[0]
        ledger = self._ledger(spec.run(first))
        if ledger is None:
            return True  # nobody knows: the workflow takes it as it is
        code = training(spec.architecture, spec.task.kind).fingerprint
        return ledger.made_from.get("code") == code and (
            ledger.made_from.get("spec") == spec.of_seed(first).canonical()
        )

    def cpu_seconds(self, cell: str, spec: Spec, block: Block) -> float:
        """About how long a job will take [s of processor time]."""
        own = self.measured.get(cell)
        if own is not None and own[0] == spec.task.steps:
            return own[1] * len(block.seeds)
        return usual(spec, len(block.seeds)) * self._correction(spec.architecture.name)

    def bytes_of_a_run(self, spec: Spec) -> float:
        """About how large a run's files are."""
        names = self._there(spec)
        sizes = []
        for seed in spec.seeds[:SAMPLED]:
            files = [file_of(spec.run(seed), kind) for kind in RUN_FILES]
            if all(file.rpartition("/")[2] in names for file in files):
                sizes.append(sum((self._results / file).stat().st_size for file in files))
        if sizes:
            return sum(sizes) / len(sizes)
        share = log(max(spec.task.steps, 100) / 100) / log(200)
        return SMALLEST + min(share, 1.0) * (LARGEST - SMALLEST)

    @cached_property
    def measured(self) -> dict[str, tuple[int, float]]:
        """Of cells that were trained here: steps of a run, and processor time of a run [s]."""
        found = {}
        for cell, spec in self._matrix.cells.items():
            seconds, runs, steps = 0.0, 0, spec.task.steps
            for block in self._matrix.blocks_of(spec):
                path = self._results / JOB_COSTS / "train" / cell / f"{block.name}.tsv"
                cost = job_cost(path)
                ledger = self._ledger(spec.run(block.seeds[0]))
                if cost is not None and cost.cpu_seconds and ledger is not None:
                    seconds += cost.cpu_seconds
                    runs, steps = runs + len(block.seeds), _steps(ledger)
            if runs and steps:
                found[cell] = steps, seconds / runs
        return found

    @cached_property
    def seconds_that_follow(self) -> float:
        """About how long what follows training takes, one job after the other [s]."""
        folder = self._results / JOB_COSTS
        jobs = [path for path in folder.glob("*.tsv") if path.stem != "readings"]
        jobs += [
            path for kind in ("figure", "comparison") for path in (folder / kind).glob("*.tsv")
        ]
        known = [cost.seconds for path in jobs if (cost := job_cost(path)) is not None]
        runs = sum(len(spec.seeds) for spec in self._matrix.cells.values())
        return sum(known) if known else FOLLOWS + FOLLOWS_A_RUN * runs

    def _correction(self, architecture: str) -> float:
        """How much longer jobs take here than usual: those of an architecture, or else all."""
        ratios = self._ratios
        own = [ratio for name, ratio in ratios if name == architecture]
        chosen = own or [ratio for _, ratio in ratios]
        return sum(chosen) / len(chosen) if chosen else 1.0

    @cached_property
    def _ratios(self) -> list[tuple[str, float]]:
        found = []
        for cell, (steps, seconds) in self.measured.items():
            spec = self._matrix.cells[cell]
            runs = len(self._matrix.blocks_of(spec)[0].seeds)
            expected = usual(spec, runs, steps) / runs
            found.append((spec.architecture.name, seconds / expected))
        return found

    def _there(self, spec: Spec) -> set[str]:
        if spec.cell not in self._names:
            folder = (self._results / file_of(spec.run(0), RUN_FILES[0])).parent
            there = folder.iterdir() if folder.is_dir() else ()
            self._names[spec.cell] = {path.name for path in there}
        return self._names[spec.cell]

    def _ledger(self, run: str) -> Ledger | None:
        if run not in self._ledgers:
            try:
                self._ledgers[run] = read_ledger(ledger_path(self._results, ledger_of_run(run)))
            except BadInput:
                self._ledgers[run] = None
        return self._ledgers[run]


def usual(spec: Spec, runs: int, steps: int | None = None) -> float:
    """What a job usually takes [s of processor time]; with ``steps``, for runs of so many."""
    architecture = spec.architecture
    a_step = OF_A_STEP.get(architecture.learner, OF_A_STEP["networks"])
    if architecture.learner == "networks" and architecture.coding != "grid":
        a_step = OF_A_STEP_OF_NETWORKS_ELSEWHERE
    return START + runs * (OF_A_RUN + a_step * (spec.task.steps if steps is None else steps))


def _steps(ledger: Ledger) -> int:
    """The steps of a run by its ledger; 0 if it does not say."""
    try:
        return int(json.loads(ledger.made_from["spec"])["task"]["steps"])
    except (KeyError, TypeError, ValueError):
        return 0
