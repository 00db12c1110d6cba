"""Which run is watched: one of the study in a folder of results, or of a configuration."""

from pathlib import Path

from upswing.runs.adopted import declared
from upswing.runs.study_file import read_study
from upswing.study.asked_run import Asked, asked_run
from upswing.study.config import ADOPTED, Study, load
from upswing.study.errors import BadInput
from upswing.study.ids import CellId, named_by
from upswing.study.paths import STUDY
from upswing.study.spec import Spec


def watched_run(
    results: Path, config: Path | None, otherwise: Path, run: str, asked: Asked
) -> Spec:
    """The specification of the run that is asked for.

    Args:
        results: the folder whose study has the names.
        config: a configuration that has them instead.
        otherwise: the configuration that has them where there are no results.
        run: as ``asked_run`` takes it.
        asked: what is said besides.

    Raises:
        BadInput: there is no such run, or it is of an adopted agent, which does not learn here.
    """
    _refuse_adopted(results, run, asked)
    spec = asked_run(_study(results, config, otherwise), run, asked)
    if spec.architecture.learner == ADOPTED:
        raise _not_here(spec.cell, spec.run(spec.seeds[0]))
    return spec


def _study(results: Path, config: Path | None, otherwise: Path) -> Study:
    """The study whose names are meant."""
    if config is None and (results / STUDY).is_file():
        return read_study(results)
    return load(config or otherwise)


def _refuse_adopted(results: Path, run: str, asked: Asked) -> None:
    """Say of an agent from elsewhere, which no study knows, why it cannot be watched."""
    named = named_by(run)
    task, architecture, seed = asked.task, asked.architecture, asked.seed
    if named is not None:
        of = CellId.parse(named.cell)
        task, architecture = task or of.task, architecture or of.architecture
        seed = named.seed if seed is None else seed
    for spec in declared(results):
        if (spec.task.name, spec.architecture.name) == (task, architecture):
            raise _not_here(spec.cell, spec.run(spec.seeds[0] if seed is None else seed))


def _not_here(cell: str, run: str) -> BadInput:
    return BadInput(
        [
            f"{cell}: is an adopted agent: it learns nothing, and only `upswing adopt` runs it; "
            f"`upswing play {run}` follows what is kept of it, `upswing browse {run}` shows the run"
        ]
    )
