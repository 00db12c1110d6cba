"""Configuration → cells → jobs → runs, with their stable ids and paths."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache, cached_property
from itertools import groupby, product

from upswing.config import Architecture, Study
from upswing.fingerprint import COMPUTING_PACKAGES, fingerprint
from upswing.spec import NamedArchitecture, NamedTask, Spec

RUN_FILES = ("trajectory.parquet", "windows.parquet", "weights.safetensors", "rrd")
"""The endings of a run's files."""


@dataclass(frozen=True)
class Block:
    """Seeds that share a job in every cell."""

    number: int
    seeds: tuple[int, ...]

    @property
    def name(self) -> str:
        """The block by its seeds: ``seeds_0_to_14``."""
        return f"seeds_{self.seeds[0]}_to_{self.seeds[-1]}"


@dataclass(frozen=True)
class Matrix:
    """The cells of a study."""

    study: Study

    @cached_property
    def cells(self) -> dict[str, Spec]:
        """Every cell by its id, with all its seeds, in the order of the experiments."""
        return {spec.cell: spec for spec in self._specs()}

    @cached_property
    def blocks(self) -> list[Block]:
        """The seeds in blocks of fixed borders, so that more seeds add blocks and change none."""
        size = self.study.seeds_per_job
        groups = groupby(sorted(self.study.seeds), key=lambda seed: seed // size)
        return [Block(number, tuple(seeds)) for number, seeds in groups]

    def job(self, cell: str, block: Block) -> Spec:
        """The specification of a cell's job for a block of seeds."""
        return self.cells[cell].model_copy(update={"seeds": block.seeds})

    @property
    def runs(self) -> Iterator[str]:
        """The id of every run."""
        for spec in self.cells.values():
            for seed in spec.seeds:
                yield spec.run(seed)

    def _specs(self) -> Iterator[Spec]:
        study = self.study
        for experiment in study.experiments:
            for task, name, alpha in product(
                experiment.tasks, experiment.architectures, experiment.alphas or (None,)
            ):
                settings, architecture = study.tasks[task], study.architectures[name]
                epsilon, discount = architecture.epsilon, architecture.discount
                yield Spec(
                    task=NamedTask(name=task, **dict(settings)),
                    architecture=NamedArchitecture(
                        name=name, **{**dict(architecture), "epsilon": None, "discount": None}
                    ),
                    alpha=alpha,
                    seeds=tuple(sorted(study.seeds)),
                    epsilon=study.epsilon if epsilon is None else epsilon,
                    discount=study.discount if discount is None else discount,
                    readings=study.readings,
                )


def training_code(architecture: Architecture, kind: str) -> str:
    """The fingerprint of the code that trains an architecture on a kind of task."""
    return _training_code(
        *(
            f"upswing.{room}.{name.replace('-', '_')}"
            for room, name in (
                ("tasks", kind),
                ("codings", architecture.coding),
                ("learners", architecture.learner),
                ("methods", architecture.method),
            )
        )
    )


@cache
def _training_code(*parts: str) -> str:
    return fingerprint("upswing.train", *parts, packages=COMPUTING_PACKAGES)
