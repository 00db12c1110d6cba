"""What several tests need: specifications, and runs of them."""

from copy import deepcopy
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from upswing.physics.environment import Trajectory, empty_trajectory
from upswing.runs.simulation import prepare
from upswing.study.architecture import architecture_named
from upswing.study.readings import Readings
from upswing.study.spec import Spec
from upswing.study.task import task_named

ARCHITECTURES: dict[str, dict[str, Any]] = {
    "table": {"learner": "table"},
    "modular-table": {"learner": "table", "modular": True},
    "networks-5": {"learner": "networks", "hidden": (5,)},
    "networks-30": {"learner": "networks", "hidden": (30,)},
    "networks-20-5": {"learner": "networks", "hidden": (20, 5)},
    "modular-networks-5": {"learner": "networks", "hidden": (5,), "modular": True},
    "modular-networks-20-5": {"learner": "networks", "hidden": (20, 5), "modular": True},
    "idle": {"learner": "control", "behaviour": "idle"},
    "random": {"learner": "control", "behaviour": "random"},
}


def make_spec(
    kind: str = "balancing",
    architecture: str = "table",
    alpha: float | None = 1,
    steps: int = 2_000,
    seeds: tuple[int, ...] = (0,),
    **readings: Any,
) -> Spec:
    """A specification; what is not given is as in the thesis."""
    settings = ARCHITECTURES[architecture]
    return Spec(
        task=task_named(kind, kind=kind, steps=steps),
        architecture=architecture_named(architecture, **settings),
        alpha=None if settings["learner"] == "control" else alpha,
        seeds=seeds,
        epsilon=0.01,
        discount=0.7,
        readings=Readings(**readings),
    )


def beyond_spec(
    kind: str = "full-control",
    alpha: float = 0.1,
    steps: int = 3_000,
    epsilon: float = 0.01,
    discount: float = 0.7,
    task: dict[str, float] | None = None,
    readings: dict[str, Any] | None = None,
    learner: str = "table",
    **options: Any,
) -> Spec:
    """A specification with parts beyond the thesis: options of the architecture by name."""
    return Spec(
        task=task_named(kind, kind=kind, steps=steps, **(task or {})),
        architecture=architecture_named("beyond", learner=learner, **options),
        alpha=alpha,
        seeds=(0,),
        epsilon=epsilon,
        discount=discount,
        readings=Readings(**(readings or {})),
    )


def run(spec: Spec, seed: int = 0, pieces: int = 1) -> tuple[Trajectory, dict[str, NDArray[Any]]]:
    """The trajectory of a run and what it learned, learned in so many pieces."""
    trajectory = empty_trajectory(spec.task.steps)
    setting = prepare(spec, seed)
    borders = np.linspace(0, spec.task.steps, pieces + 1).astype(int)
    for first, last in pairwise(borders):
        setting.advance(trajectory, int(first), int(last))
    return trajectory, deepcopy(dict(setting.learner.learned))


def assert_same(one: Trajectory, other: Trajectory) -> None:
    """Every column of both is the same, NaN being NaN."""
    for name, a, b in zip(one._fields, one, other, strict=True):
        np.testing.assert_array_equal(a, b, err_msg=name)


def columns_of_recording(path: Path) -> dict[str, list[str]]:
    """All data of a Rerun recording by entity and column, in an order of its own, without times of writing."""
    import rerun as rr

    reader = rr.chunk.RrdReader(path)
    (store,) = reader.recordings()
    found: dict[str, list[str]] = {}
    for chunk in reader.stream(store=store):
        entity = str(chunk.entity_path)
        if not entity.startswith("/__properties"):
            batch = chunk.to_record_batch()
            for name in batch.schema.names:
                if "rowid" not in name.lower() and "log_t" not in name:
                    found.setdefault(f"{entity} {name}", []).append(str(batch[name].to_pylist()))
    return {name: sorted(rows) for name, rows in found.items()}
