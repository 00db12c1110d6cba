"""Which code trains a run: the modules that are reached by import, and those loaded by name.

A fingerprint follows ``import`` statements. What is loaded by name (a task, a learner) no statement
shows, so it is said here. It is apart from ``jobs``, which knows the other kinds of job, so that
training depends on no more of the study than it needs.
"""

from collections.abc import Iterable
from functools import cache
from typing import NamedTuple

from upswing.study.architecture import Architecture
from upswing.study.fingerprint import COMPUTING_PACKAGES, fingerprint, reachable
from upswing.study.loading import module_of


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
        ("features", architecture.coding),
        ("learners", architecture.learner),
        ("algorithms", architecture.method),
    ]
    named += [("learners", inner) for inner in architecture.inner_learners()]
    return tuple(module_of(part, name) for part, name in named)


def learning(*entries: str, used: Iterable[tuple[Architecture, str]]) -> Code:
    """The code of a job that starts from ``entries`` and lets architectures learn kinds of tasks."""
    loaded: set[str] = set()
    packages = {*COMPUTING_PACKAGES}
    for architecture, kind in used:
        loaded.update(loaded_by_name(architecture, kind))
        packages.update(architecture.computes_with)
    return Code((*entries, *sorted(loaded)), tuple(sorted(packages)))


def training(architecture: Architecture, kind: str) -> Code:
    """The code that trains an architecture on a kind of task."""
    return learning("upswing.runs.train", used=[(architecture, kind)])
