"""Configuration → cells → jobs → runs, with their stable ids and paths."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import groupby, product
from pathlib import Path

from upswing.study.architecture import architecture_named
from upswing.study.config import Experiment, Study
from upswing.study.ids import KNOWN_FILE, cell_id, file_of
from upswing.study.shown import HOW_SHOWN
from upswing.study.spec import Spec
from upswing.study.task import task_named


@dataclass(frozen=True)
class Block:
    """Seeds that share a job, in every cell that has all of them and no other of their number."""

    number: int
    seeds: tuple[int, ...]

    @property
    def name(self) -> str:
        """The block by its seeds: ``seeds_0_to_29``, or with gaps ``seeds_0_to_29_of_which_12``."""
        first, last, count = self.seeds[0], self.seeds[-1], len(self.seeds)
        gaps = "" if count == last - first + 1 else f"_of_which_{count}"
        return f"seeds_{first}_to_{last}{gaps}"


@dataclass(frozen=True)
class Matrix:
    """The cells of a study."""

    study: Study

    @cached_property
    def cells(self) -> dict[str, Spec]:
        """Every cell by its id, with all its seeds, in the order of the experiments."""
        return {spec.cell: spec for spec in self._specs()}

    @cached_property
    def blocks(self) -> dict[Block, list[str]]:
        """Every block, in the order of its number, with the cells that have it."""
        cells: dict[Block, list[str]] = {}
        for cell, spec in self.cells.items():
            for block in self.blocks_of(spec):
                cells.setdefault(block, []).append(cell)
        return dict(sorted(cells.items(), key=lambda pair: (pair[0].number, pair[0].seeds)))

    def blocks_of(self, spec: Spec) -> list[Block]:
        """A cell's seeds in blocks of fixed borders, so that more seeds add blocks and change none."""
        return _blocks(spec.seeds, self.study.seeds_per_job)

    def job(self, cell: str, block: Block) -> Spec:
        """The specification of a cell's job for a block of seeds."""
        return self.cells[cell].model_copy(update={"seeds": block.seeds})

    @property
    def runs(self) -> Iterator[str]:
        """The id of every run."""
        for spec in self.cells.values():
            for seed in spec.seeds:
                yield spec.run(seed)

    def wanted(self, results: Path) -> Iterator[str]:
        """A file of every job, below ``results``: the first that is missing there, or else its first.

        Who has one file of a job has them all. Snakemake compares each file that it is asked for with
        each that some rule makes, and so to ask for all of them takes a time that grows with the square
        of the runs.
        """
        for spec in self.cells.values():
            folder = (results / file_of(spec.run(spec.seeds[0]), KNOWN_FILE)).parent
            there = {path.name for path in folder.iterdir()} if folder.is_dir() else set[str]()
            for block in self.blocks_of(spec):
                files = [file_of(spec.run(seed), KNOWN_FILE) for seed in block.seeds]
                missing = (file for file in files if file.rpartition("/")[2] not in there)
                yield f"{results}/{next(missing, files[0])}"

    def spec(self, task: str, name: str, alpha: float | None, seeds: tuple[int, ...]) -> Spec:
        """The specification of a task, an architecture and a step size, for some seeds."""
        study, architecture = self.study, self.study.architectures[name]
        discount = architecture.discount
        learning = {key: value for key, value in architecture if key not in HOW_SHOWN}
        return Spec(
            task=task_named(task, **dict(study.tasks[task])),
            architecture=architecture_named(
                name, **{**learning, "epsilon": None, "discount": None}
            ),
            alpha=alpha,
            seeds=tuple(sorted(seeds)),
            epsilon=architecture.epsilon_in(study.epsilon),
            discount=study.discount if discount is None else discount,
            readings=study.readings,
        )

    def _specs(self) -> Iterator[Spec]:
        for experiment in self.study.experiments:
            for task, name, alpha in _combinations(experiment):
                yield self.spec(task, name, alpha, seeds_of(experiment, self.study))


@cache
def _blocks(seeds: tuple[int, ...], size: int) -> list[Block]:
    groups = groupby(sorted(seeds), key=lambda seed: seed // size)
    return [Block(number, tuple(own)) for number, own in groups]


def seeds_of(experiment: Experiment, study: Study) -> tuple[int, ...]:
    """The seeds of an experiment's cells: its own, or the study's."""
    return study.seeds if experiment.seeds is None else experiment.seeds


def cells_of(experiment: Experiment) -> list[str]:
    """The ids of an experiment's cells, in order."""
    return [cell_id(task, name, alpha) for task, name, alpha in _combinations(experiment)]


def _combinations(experiment: Experiment) -> Iterator[tuple[str, str, float | None]]:
    yield from product(experiment.tasks, experiment.architectures, experiment.alphas or (None,))


def canonical_search(study: Study) -> str:
    """All that the search of a study depends on besides the code, as one line."""
    if study.search is None:
        return ""
    return "\n".join(
        [
            study.search.model_dump_json(),
            *(Matrix(study).spec(*combination).canonical() for combination in searched(study)),
        ]
    )


def searched(study: Study) -> Iterator[tuple[str, str, float, tuple[int, ...]]]:
    """Task, architecture, step size and seeds of all that a study searches through."""
    if study.search is not None:
        for candidates in study.search.candidates:
            for name, alpha in product(candidates.architectures, candidates.alphas):
                yield study.search.task, name, alpha, study.search.seeds
