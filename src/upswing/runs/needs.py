"""What a job needs of the machine that it is placed on: memory and minutes, from what was measured.

Twice the memory and ten times the time that the largest job of its kind took in the full study, on two
cores of a laptop's kind; and as much again at every further attempt (``--retries``).
"""

from collections.abc import Callable
from math import ceil
from typing import Any

from upswing.runs.outlook import usual
from upswing.study.config import Study
from upswing.study.matrix import Matrix, searched
from upswing.study.spec import Spec

MEASURED = {
    "study": (10, 0.2), "tables": (286, 3.4), "tiles": (274, 2.1), "verdicts": (358, 2.7),
    "figure": (312, 6.2), "comparison": (306, 6.9), "viewer": (270, 2.5), "history": (167, 0.7),
    "report": (309, 2.6), "sweep": (532, 357.4), "finalists": (339, 3.2), "readings": (808, 36.6),
    "bound": (469, 76.0), "changes": (298, 4.1), "settling": (284, 4.6),
    "prediction": (630, 45.0),
}  # fmt: skip
"""The largest job of each rule, in 3,500 runs with all sweeps: memory [MB], time by the clock [s].

Of the last four the time is of the processor.
"""

LEAST_MEMORY, LEAST_MINUTES = 500, 5
"""What every job is given to start: Python and its imports, on a file system that others share."""

LEARNING, LEARNING_A_MILLION = 849, 26
"""Memory of a job of training [MB]: networks, while the loop is compiled; and of a million steps."""

MORE_MEMORY, MORE_TIME = 2, 10

Need = Callable[[Any, int], int]
"""By wildcards and attempt, as Snakemake asks."""


def memory(rule: str) -> Need:
    """What a job of a rule needs at most [MB]."""
    need = max(LEAST_MEMORY, _hundreds(MORE_MEMORY * MEASURED[rule][0]))
    return lambda _, attempt: attempt * need


def minutes(rule: str) -> Need:
    """How long a job of a rule takes at most."""
    need = _minutes(MEASURED[rule][1])
    return lambda _, attempt: attempt * need


def memory_of_training(steps: int) -> int:
    """What a job needs at most that learns runs of so many steps [MB]."""
    return _hundreds(MORE_MEMORY * (LEARNING + LEARNING_A_MILLION * steps / 1e6))


def minutes_of_training(job: Spec) -> int:
    """How long a job takes at most that learns the runs of a specification."""
    return _minutes(usual(job, len(job.seeds)))


def needs_of_search(study: Study) -> tuple[int, int]:
    """What the search of a study needs at most: memory [MB] and minutes; little where there is none."""
    if study.search is None:
        return LEAST_MEMORY, LEAST_MINUTES
    longest = max(study.search.lengths)
    specs = [Matrix(study).spec(*one) for one in searched(study)]
    seconds = sum(usual(spec, len(spec.seeds), longest) for spec in specs)
    return memory_of_training(longest), _minutes(seconds)


def _hundreds(megabytes: float) -> int:
    return 100 * ceil(megabytes / 100)


def _minutes(seconds: float) -> int:
    return LEAST_MINUTES + ceil(MORE_TIME * seconds / 60)
