"""The cells that were adopted: agents from elsewhere whose runs stand beside those of the study.

A study says which cells it has; no rule trains these. So each has a file of its own in the folder of
results, ``adopted/{task}/{architecture}.json``, which holds its specification with all its seeds, and is
all that makes it part of the study: without it, its runs are orphans. Tables, figures and catalog read
the cells of a folder here. Verdicts do not change, since a claim names its cells.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from upswing.runs.files.atomic import written
from upswing.runs.study_file import read_study
from upswing.study.architecture import Architecture, architecture_named
from upswing.study.config import ADOPTED, Study
from upswing.study.errors import BadInput
from upswing.study.ids import cell_of
from upswing.study.matrix import Matrix
from upswing.study.readings import Readings
from upswing.study.spec import Spec, parse
from upswing.study.task import task_named

if TYPE_CHECKING:
    import pandas as pd

FOLDER = "adopted"
"""Where the files are, below the folder of results."""

CONTROL = "control"
"""A learner of the study that learns as little."""


@dataclass(frozen=True)
class Joined(Matrix):
    """The cells of a study, and behind them those that were adopted."""

    adopted: tuple[Spec, ...] = ()
    left_out: tuple[Spec, ...] = ()
    """Adopted when the study had another task of this name, or other readings: not comparable."""

    def _specs(self) -> Iterator[Spec]:
        yield from super()._specs()
        yield from self.adopted


def joined(results: Path, study: Study | None = None) -> Joined:
    """The cells of a folder of results: those of its study, and the adopted ones that go with it.

    Args:
        results: the folder.
        study: the study that is asked for; without, the one that the folder is of.

    Raises:
        BadInput: the study, or the file of an adopted cell, cannot be read.
    """
    asked = read_study(results) if study is None else study
    cells = declared(results)
    go = {spec.cell: _goes_with(spec, asked) for spec in cells}
    return Joined(
        asked,
        adopted=tuple(spec for spec in cells if go[spec.cell]),
        left_out=tuple(spec for spec in cells if not go[spec.cell]),
    )


def files_of(results: Path) -> list[Path]:
    """The files of all adopted cells, in order."""
    return sorted((results / FOLDER).glob("*/[!.]*.json"))


def declared(results: Path) -> list[Spec]:
    """The specifications of all adopted cells."""
    return [_read(path) for path in files_of(results)]


def file_of_cell(results: Path, spec: Spec) -> Path:
    """The file of an adopted cell."""
    return results / FOLDER / spec.task.name / f"{spec.architecture.name}.json"


def declare(results: Path, spec: Spec) -> Path:
    """Make a cell, whose runs are there, part of what is in a folder of results; returns its file."""
    path = file_of_cell(results, spec)
    with written(path) as beside:
        beside.write_text(spec.canonical() + "\n", "utf-8")
    return path


def specified(study: Study, task: str, architecture: Architecture, seeds: tuple[int, ...]) -> Spec:
    """The specification of an agent's runs over a task of a study; ``architecture`` has a name.

    It does not explore, and nothing is discounted where nothing is learned. Of the readings it has those
    that touch what happens, and not those of learners.
    """
    kind, asked = study.tasks[task].kind, study.readings
    readings = {**asked.touching(CONTROL, kind, False), "reset": asked.reset}
    return Spec(
        task=task_named(task, **dict(study.tasks[task])),
        architecture=architecture_named(**dict(architecture)),
        alpha=None,
        seeds=tuple(sorted(seeds)),
        epsilon=0.0,
        discount=0.0,
        readings=Readings(**readings),
    )


def with_origin(runs: "pd.DataFrame", cells: Mapping[str, Spec]) -> "pd.DataFrame":
    """A table of runs with a column ``origin``: the study, or which agent was adopted."""
    said = {cell: origin(spec) for cell, spec in cells.items()}
    return runs.assign(origin=runs["run"].map(cell_of).map(said))


def origin(spec: Spec) -> str:
    """Where the runs of a cell come from, in words: ``study``, or ``adopted: ppo.py:policy (…)``."""
    if spec.architecture.learner != ADOPTED:
        return "study"
    found = spec.architecture.model_dump()
    made_with = f" ({found['made_with']})" if found["made_with"] else ""
    return f"adopted: {found['agent']}{made_with}"


def _goes_with(spec: Spec, study: Study) -> bool:
    """Whether a cell is one of this study: the same task of this name, the same readings."""
    name = spec.task.name
    if name not in study.tasks or spec.architecture.name in study.architectures:
        return False
    as_now = specified(study, name, spec.architecture, spec.seeds)
    return as_now.canonical() == spec.canonical()


def _read(path: Path) -> Spec:
    remedy = "delete it, and adopt the agent again"
    try:
        spec = parse(path.read_text("utf-8"))
    except OSError as error:
        raise BadInput([f"{path}: cannot be read: {error.strerror}"]) from None
    except UnicodeDecodeError:
        raise BadInput([f"{path}: is not text in UTF-8; {remedy}"]) from None
    except BadInput as error:
        raise BadInput([f"{path}: {problem}; {remedy}" for problem in error.problems]) from None
    if spec.architecture.learner != ADOPTED:
        raise BadInput([f"{path}: is of no adopted agent but of a {spec.architecture.learner}"])
    if (spec.task.name, spec.architecture.name) != (path.parent.name, path.stem):
        raise BadInput([f"{path}: is of {spec.cell}; {remedy}"])
    return spec
