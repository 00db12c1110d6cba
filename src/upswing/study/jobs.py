"""Which code a job of the workflow runs: the only place that answers, for every kind of job.

A fingerprint follows ``import`` statements. What is loaded by name (a task, a learner, a figure) no
statement shows, so it is said here; ``tests/workflow/test_jobs.py`` runs every kind of job and compares.
"""

from collections.abc import Iterable
from functools import cache
from itertools import product
from typing import TYPE_CHECKING, NamedTuple

from upswing.study.config import Architecture, Study
from upswing.study.fingerprint import COMPUTING_PACKAGES, fingerprint, reachable
from upswing.study.loading import inner_learner, module_of
from upswing.study.matrix import Matrix, searched

if TYPE_CHECKING:
    from upswing.study.sweeps import Sweep


class Code(NamedTuple):
    """The code of a job."""

    entries: tuple[str, ...]  # the modules that it starts from, and those that it loads by name
    packages: tuple[str, ...]  # distributions whose versions belong to its result

    @property
    def modules(self) -> set[str]:
        """Every module of this package that it may import."""
        return reachable(*self.entries)

    @property
    def fingerprint(self) -> str:
        """16 hexadecimal digits that change with the meaning of the code."""
        return _fingerprint(self)


@cache
def _fingerprint(code: Code) -> str:
    return fingerprint(*code.entries, packages=code.packages)


def loaded_by_name(architecture: Architecture, kind: str) -> tuple[str, ...]:
    """The modules that are loaded by name when an architecture learns a kind of task."""
    named = [
        ("tasks", kind),
        ("codings", architecture.coding),
        ("learners", architecture.learner),
        ("methods", architecture.method),
    ]
    if inner := inner_learner(architecture.learner, architecture.hidden):
        named.append(("learners", inner))
    return tuple(module_of(part, name) for part, name in named)


def _learning(*entries: str, used: Iterable[tuple[Architecture, str]]) -> Code:
    loaded = {part for architecture, kind in used for part in loaded_by_name(architecture, kind)}
    return Code((*entries, *sorted(loaded)), COMPUTING_PACKAGES)


def training(architecture: Architecture, kind: str) -> Code:
    """The code that trains an architecture on a kind of task."""
    return _learning("upswing.runs.train", used=[(architecture, kind)])


def sweep(swept: "Sweep", study: Study) -> Code:
    """The code that runs a sweep's cells under other readings."""
    cells = Matrix(study).cells
    specs = [cells[cell] for cell in (*swept.cells, *swept.cells_of_singles)]
    used = [(study.architectures[one.architecture.name], one.task.kind) for one in specs]
    return _learning("upswing.runs.sweep", "upswing.runs.study_file", used=used)


def search(study: Study) -> Code:
    """The code of a study's search for what succeeds every time."""
    used = [
        (study.architectures[name], study.tasks[task].kind) for task, name, *_ in searched(study)
    ]
    return _learning("upswing.analysis.search", used=used)


def bound() -> Code:
    """The code of the bound; it follows policies on both tasks, and trains tables to begin with."""
    table = Architecture(learner="table")
    return _learning("upswing.optimal.bound", used=product([table], ["balancing", "full-control"]))


def figure(name: str) -> Code:
    """The code that draws a figure."""
    return Code(("upswing.figures", module_of("figures", name)), ("matplotlib",))


def page(figures: Iterable[str]) -> Code:
    """The code of the page, which asks each figure what it shows."""
    return Code(("upswing.report.page", *(module_of("figures", name) for name in figures)), ())


TABLES = Code(("upswing.analysis.aggregate", "upswing.runs.study_file"), ())
VERDICTS = Code(("upswing.analysis.verdicts",), ("scipy",))
CHANGES = Code(("upswing.analysis.ablation",), ("scipy",))
READINGS = Code(
    ("upswing.analysis.robustness.results", "upswing.figures.readings"), ("scipy", "matplotlib")
)
COMPARISONS = Code(("upswing.recordings.comparison",), ("rerun-sdk",))
VIEWER = Code(("upswing.recordings.viewer",), ("rerun-sdk",))
