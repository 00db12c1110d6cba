"""Which code a job of the workflow runs: the only place that answers, for every kind of job.

A fingerprint follows ``import`` statements. What is loaded by name (a task, a learner, a figure) no
statement shows, so it is said here; ``tests/workflow/test_jobs.py`` runs every kind of job and compares.
"""

from collections.abc import Iterable
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

from upswing.study.architecture import architecture_of
from upswing.study.code import Code, learning
from upswing.study.code import training as training
from upswing.study.config import Study
from upswing.study.fingerprint import COMPUTING_PACKAGES
from upswing.study.loading import module_of
from upswing.study.matrix import Matrix, searched
from upswing.study.own_code import OwnCode
from upswing.study.own_figures import FigureFile, OwnFigure

if TYPE_CHECKING:
    from upswing.study.sweeps import Sweep


FROM_PANELS = "upswing.figures.from_panels"
"""What draws figures that are declared, loaded by name so that no other figure depends on it."""


KINDS = ("balancing", "full-control")
"""The thesis's tasks. A figure of the thesis asks them for the grid of its cells."""


def sweep(swept: "Sweep", study: Study) -> Code:
    """The code that runs a sweep's cells under other readings."""
    cells = Matrix(study).cells
    specs = [cells[cell] for cell in swept.every_cell]
    used = [(study.architectures[one.architecture.name], one.task.kind) for one in specs]
    return learning("upswing.runs.sweep", "upswing.runs.study_file", used=used)


def search(study: Study) -> Code:
    """The code of a study's search for what succeeds every time."""
    used = [
        (study.architectures[name], study.tasks[task].kind) for task, name, *_ in searched(study)
    ]
    return learning("upswing.analysis.search", used=used)


def bound() -> Code:
    """The code of the bound; it follows policies on both tasks, and trains tables to begin with."""
    table = architecture_of(learner="table")
    return learning("upswing.optimal.bound", used=product([table], KINDS))


OF_ITS_PENDULUM = ("upswing.optimal.body", "upswing.runs.study_file")
"""What reads a study and tells its pendulum, for jobs that need no more of it."""

SETTLING = Code(("upswing.optimal.settling", *OF_ITS_PENDULUM), COMPUTING_PACKAGES)
PREDICTION = Code(
    ("upswing.optimal.prediction", *OF_ITS_PENDULUM, module_of("tasks", "balancing")),
    COMPUTING_PACKAGES,
)


def tiles() -> Code:
    """The code that looks for a policy on the thesis's tiles; it begins with a table that learned."""
    table = architecture_of(learner="table")
    return learning("upswing.optimal.represented", used=product([table], ["full-control"]))


def figure(figure: str | OwnFigure) -> Code | OwnCode:
    """The code that draws a figure: of the project, by its name, or of a study's own."""
    drawing = ("matplotlib", "scipy")
    if isinstance(figure, str):
        tasks = (module_of("tasks", kind) for kind in KINDS)
        return Code(("upswing.figures", module_of("figures", figure), *tasks), drawing)
    if isinstance(figure, FigureFile):
        return OwnCode(Path(figure.file), ("upswing.figures", "upswing.figures.panels"), drawing)
    return Code(("upswing.figures", FROM_PANELS), drawing)


def page(figures: Iterable[str]) -> Code:
    """The code of the page, which asks each figure what it shows."""
    return Code(("upswing.report.page", *(module_of("figures", name) for name in figures)), ())


TABLES = Code(("upswing.analysis.aggregate", "upswing.runs.adopted"), ())
VERDICTS = Code(
    (
        "upswing.analysis.verdicts", "upswing.analysis.contraction",
        "upswing.analysis.robustness.shipped",
    ),
    ("scipy",),
)  # fmt: skip
HISTORY = Code(("upswing.analysis.history.write",), ())
CHANGES = Code(("upswing.analysis.ablation",), ("scipy",))
JUDGED_OVER_READINGS = Code(
    ("upswing.analysis.robustness.write", "upswing.analysis.contraction"), ("scipy",)
)
READINGS = Code(
    (*JUDGED_OVER_READINGS.entries, "upswing.figures.readings"), ("scipy", "matplotlib")
)
FINALISTS = Code(("upswing.analysis.robustness.selection", "upswing.runs.study_file"), ())
COMPARISON = Code(("upswing.recordings.comparison",), ("rerun-sdk", "scipy"))
VIEWER = Code(("upswing.recordings.viewer",), ("rerun-sdk",))
