"""Parts that are chosen by the name of their file: tasks, codings, learners, methods, figures.

They are imported when they are needed, so that a table never waits for torch.
"""

from importlib import import_module
from typing import Any


def module_of(folder: str, name: str) -> str:
    """The module of a part: ``("methods", "q-learning")`` is ``upswing.methods.q_learning``."""
    return f"upswing.{folder}.{name.replace('-', '_')}"


def load(folder: str, name: str) -> Any:
    """The module itself."""
    return import_module(module_of(folder, name))


def inner_learner(learner: str, hidden: tuple[int, ...]) -> str | None:
    """The learner that a learner is made of, by name: the modules of ``gated``; None for any other."""
    if learner != "gated":
        return None
    return "networks" if hidden else "table"
