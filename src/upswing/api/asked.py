"""What a caller asks to be trained → a specification, checked as a configuration is."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from upswing.study.config import validated
from upswing.study.errors import BadInput, near, problem
from upswing.study.matrix import Matrix
from upswing.study.spec import Spec

OWN = "own"
"""The name of a task or an architecture that is given by its keys, and not by a name."""

Given = str | Mapping[str, Any]
"""A name, or the keys that a configuration has for it (and ``name``, if it is to have one)."""


def specified(
    base: Mapping[str, Any],
    task: Given,
    architecture: Given,
    alpha: float | None,
    seed: int,
    steps: int | None = None,
    epsilon: float | None = None,
    discount: float | None = None,
    readings: Mapping[str, Any] | None = None,
    pendulum: Mapping[str, Any] | None = None,
) -> Spec:
    """The specification of a run.

    Args:
        base: a configuration as plain values: its tasks and architectures by name, and its ε, γ and
            readings where it has any.
        task: the name of one, or keys of its own: ``{"kind": "balancing", "steps": 10_000}``.
        architecture: the name of one, or keys: ``{"learner": "networks", "hidden": [10]}``.
        alpha: the step size α; None for a control.
        seed: of the run.
        steps: its length in place of the task's [steps].
        epsilon: ε in place of the configuration's and the architecture's.
        discount: γ likewise.
        readings: readings in place of the configuration's, by their keys.
        pendulum: what moves, in place of the task's, by the keys of a task's ``pendulum``.

    Raises:
        BadInput: something is not known or does not go together.
    """
    task_name, of_task = _part(base, "tasks", task)
    if pendulum is not None:
        of_task["pendulum"] = {**of_task.get("pendulum", {}), **pendulum}
    name, of_architecture = _part(base, "architectures", architecture)
    own = {"epsilon": epsilon, "discount": discount}
    content: dict[str, Any] = {
        **{key: base[key] for key in ("epsilon", "discount") if key in base},
        "seeds": [seed],
        "tasks": {task_name: {**of_task, **({} if steps is None else {"steps": steps})}},
        "architectures": {
            name: {
                **of_architecture,
                **{key: value for key, value in own.items() if value is not None},
            }
        },
        "experiments": [
            {
                "tasks": [task_name],
                "architectures": [name],
                **({} if alpha is None else {"alphas": [alpha]}),
            }
        ],
        "readings": {**base.get("readings", {}), **(readings or {})},
    }
    try:
        (spec,) = Matrix(validated({"train": content})).cells.values()
    except BadInput as error:
        raise BadInput(list(_as_asked(error.problems))) from None
    return spec


PLACES = {
    "experiments[0].alphas[0]": "alpha", "experiments[0].alphas": "alpha", "seeds[0]": "seed",
}  # fmt: skip
"""Where in a configuration the arguments stand."""

LISTS = ("train: seeds:", "train: experiments:")
"""What is wrong with a whole list is only that something in it is."""


def _as_asked(problems: Sequence[str]) -> Iterator[str]:
    """Problems of a configuration as those of the arguments that it is made from."""
    for line in problems:
        if not line.startswith(LISTS) or len(problems) == 1:
            for place, argument in PLACES.items():
                line = line.replace(f"train: {place}:", f"train: {argument}:")
            yield line


def _part(base: Mapping[str, Any], kind: str, given: Given) -> tuple[str, dict[str, Any]]:
    """The name and the keys of a task or an architecture."""
    if isinstance(given, Mapping):
        keys = dict(given)
        return str(keys.pop("name", OWN)), keys
    known = base[kind]
    if given not in known:
        raise BadInput([problem("train", kind.removesuffix("s"), given, near(given, known))])
    return given, dict(known[given])
