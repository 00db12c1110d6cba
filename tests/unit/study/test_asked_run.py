"""One run is asked for: by its id, a path, a specification, or what it is made of."""

import pytest

from tests.helpers import ARCHITECTURES
from upswing.study.asked_run import Asked, asked_run
from upswing.study.config import validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix

STUDY = validated(
    {
        "study": {
            "seeds": 2,
            "tasks": {"full-control": {"kind": "full-control", "steps": 3_000}},
            "architectures": {name: ARCHITECTURES[name] for name in ("table", "idle")},
            "experiments": [
                {"tasks": ["full-control"], "architectures": ["table"], "alphas": [0.01]},
                {"tasks": ["full-control"], "architectures": ["idle"]},
            ],
        }
    }
)
CELL = Matrix(STUDY).cells["full-control/table/alpha-0.01"]
RUN = "full-control/table/alpha-0.01/seed-1"


@pytest.mark.parametrize(
    ("run", "asked"),
    [
        (RUN, Asked()),
        (f"results/runs/{RUN}.weights.safetensors", Asked()),
        (f"/elsewhere/{RUN}.rrd", Asked()),
        ("full-control/table/alpha-0.01", Asked(seed=1)),
        ("full-control/table/alpha-0.5/seed-7", Asked(alpha=0.01, seed=1)),
        ("", Asked("full-control", "table", 0.01, 1)),
        (CELL.of_seed(1).canonical(), Asked()),
        (CELL.canonical(), Asked(seed=1)),
        (CELL.canonical(), Asked(seed=1, steps=3_000)),
    ],
)
def test_a_run_of_the_study_is_its_own_specification(run, asked):
    assert asked_run(STUDY, run, asked).canonical() == CELL.of_seed(1).canonical()


def test_a_run_need_not_be_of_the_study():
    spec = asked_run(STUDY, "full-control/table/alpha-0.5/seed-77", Asked(steps=10))
    assert (spec.run(77), spec.seeds, spec.task.steps) == (
        "full-control/table/alpha-0.5/seed-77", (77,), 10,
    )  # fmt: skip
    assert asked_run(STUDY, "", Asked("full-control", "idle")).run(0).endswith("alpha-none/seed-0")


@pytest.mark.parametrize(
    ("run", "asked", "words"),
    [
        ("seed-1", Asked(), "seed-1: a run is task/architecture/alpha-α/seed-n"),
        ("full-control/table/alpha-x/seed-1", Asked(), "a run is task/architecture"),
        (
            "full-control/tabel/alpha-1/seed-1",
            Asked(),
            "architecture: tabel: unknown; did you mean",
        ),
        ("balancing/table/alpha-1/seed-1", Asked(), "task: balancing: unknown; there are full-c"),
        ("full-control/table/alpha-2/seed-1", Asked(), "alpha: 2.0: must be in (0, 1]"),
        ("full-control/table/alpha-none/seed-1", Asked(), "--alpha: missing: table learns"),
        ("full-control/idle/alpha-1/seed-1", Asked(), "idle does not learn and has no α"),
        (RUN, Asked(seed=-1), "seed: -1: must be a whole number from 0"),
        (RUN, Asked(steps=0), "--steps: 0: must be a number of steps"),
        ("", Asked(), "--task: missing; say a run by its id"),
        ("", Asked("full-control"), "--architecture: missing"),
        (CELL.canonical(), Asked(), "seeds: [0, 1]: one run is shown; say which by --seed"),
        (CELL.canonical(), Asked(alpha=0.5), "--alpha: the specification says it already"),
        ('{"task"', Asked(), "is not JSON"),
    ],
)
def test_what_is_not_understood_is_explained(run, asked, words):
    with pytest.raises(BadInput) as caught:
        asked_run(STUDY, run, asked)
    assert words in str(caught.value)
