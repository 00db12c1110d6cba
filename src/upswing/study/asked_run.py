"""One run, however it is asked for: by its id, by a specification in JSON, or by what it is made of."""

import re
from typing import Any, NamedTuple

from pydantic import TypeAdapter, ValidationError

from upswing.study.config import Study
from upswing.study.errors import BadInput, near, problem
from upswing.study.ids import RUN_FILES
from upswing.study.matrix import Matrix
from upswing.study.names import NO_ALPHA, Alpha
from upswing.study.spec import Spec, parse
from upswing.study.values import LARGEST_SEED, LONGEST_RUN, Seed, Steps

FORM = "a run is task/architecture/alpha-α/seed-n: full-control/table/alpha-0.01/seed-3"


class Asked(NamedTuple):
    """What a run is made of; None is not said, and may be said by its id."""

    task: str | None = None
    architecture: str | None = None
    alpha: float | None = None
    seed: int | None = None
    steps: int | None = None


def asked_run(study: Study, run: str, asked: Asked) -> Spec:
    """The specification of one run, which need not be of the study.

    Args:
        study: whose tasks, architectures and settings are meant by their names.
        run: an id of a run or a cell, the path of one of a run's files, a specification, or nothing.
        asked: what is said besides; it goes before what ``run`` says. Without a seed it is 0.

    Raises:
        BadInput: it is not said which, or there is no such task, architecture, α, seed or length.
    """
    if run.lstrip().startswith("{"):
        spec = _given(run, asked)
    else:
        said = _said_by(run) if run else Asked()
        chosen = {name: value for name, value in asked._asdict().items() if value is not None}
        spec = _made(study, said._replace(**chosen))
    if asked.steps is None:
        return spec
    right = f"must be a number of steps from 1 to {LONGEST_RUN:,}"
    steps = _checked(Steps, "--steps", asked.steps, right)
    return spec.model_copy(update={"task": spec.task.model_copy(update={"steps": steps})})


def _given(text: str, asked: Asked) -> Spec:
    spec = parse(text)
    if extra := [name for name in ("task", "architecture", "alpha") if getattr(asked, name)]:
        raise BadInput([f"--{extra[0]}: the specification says it already; leave it out"])
    if asked.seed is None and len(spec.seeds) > 1:
        raise BadInput([f"spec: seeds: {list(spec.seeds)}: one run is shown; say which by --seed"])
    return spec.of_seed(spec.seeds[0] if asked.seed is None else _seed(asked.seed))


def _said_by(run: str) -> Asked:
    """The parts of an id, or of a path that ends with one."""
    for ending in RUN_FILES:
        run = run.removesuffix(f".{ending}")
    number = r"[0-9]+(?:\.[0-9]+)?"
    form = rf"(?:.*/)?([^/]+)/([^/]+)/alpha-({number}|{NO_ALPHA})(?:/seed-([0-9]+))?/?"
    found = re.fullmatch(form, run)
    if found is None:
        raise BadInput([f"{run}: {FORM}"])
    task, architecture, alpha, seed = found.groups()
    return Asked(
        task,
        architecture,
        None if alpha == NO_ALPHA else float(alpha),
        None if seed is None else int(seed),
    )


def _made(study: Study, asked: Asked) -> Spec:
    """The run that is made of these parts."""
    if asked.task is None or asked.architecture is None:
        lacking = "--task" if asked.task is None else "--architecture"
        right = "say a run by its id, or its --task, --architecture and --alpha"
        raise BadInput([f"{lacking}: missing; {right}"])
    for kind, name, known in (
        ("task", asked.task, study.tasks),
        ("architecture", asked.architecture, study.architectures),
    ):
        if name not in known:
            raise BadInput([f"{kind}: {name}: unknown; {near(name, known)}"])
    learns = study.architectures[asked.architecture].learns
    if learns and asked.alpha is None:
        raise BadInput([f"--alpha: missing: {asked.architecture} learns with an α in (0, 1]"])
    if not learns and asked.alpha is not None:
        right = f"{asked.architecture} does not learn and has no α; leave it out"
        raise BadInput([problem("run", "alpha", asked.alpha, right)])
    alpha = asked.alpha
    if alpha is not None:
        alpha = _checked(Alpha, "alpha", alpha, "must be in (0, 1]")
    seed = _seed(0 if asked.seed is None else asked.seed)
    return Matrix(study).spec(asked.task, asked.architecture, alpha, (seed,))


def _seed(seed: int) -> int:
    return int(_checked(Seed, "seed", seed, f"must be a whole number from 0 to {LARGEST_SEED}"))


def _checked(kind: Any, name: str, value: Any, right: str) -> Any:
    try:
        return TypeAdapter(kind).validate_python(value)
    except ValidationError:
        raise BadInput([f"{name}: {value}: {right}"]) from None
