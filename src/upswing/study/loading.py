"""Parts that are chosen by the name of their file: tasks, codings, learners, methods, figures.

They are imported when they are needed, so that a table never waits for torch.
"""

from importlib import import_module
from pathlib import Path
from typing import Any

PACKAGES = {
    "tasks": "upswing.physics.tasks",
    "codings": "upswing.agents.features",
    "learners": "upswing.agents.learners",
    "methods": "upswing.agents.algorithms",
    "figures": "upswing.figures",
}
"""Where the parts of each kind lie."""

BESIDE = ("episodes",)
"""Files beside the parts that are none."""


def module_of(folder: str, name: str) -> str:
    """The module of a part by its kind and its name in the configuration."""
    return f"{PACKAGES[folder]}.{name.replace('-', '_')}"


def parts(folder: str) -> list[str]:
    """The names of the parts of a kind: what there is to choose from."""
    place = Path(__file__).parents[2].joinpath(*PACKAGES[folder].split("."))
    names = (path.stem for path in place.glob("[a-z]*.py"))
    return sorted(name.replace("_", "-") for name in names if name not in BESIDE)


def load(folder: str, name: str) -> Any:
    """The module itself."""
    return import_module(module_of(folder, name))


def inner_learner(learner: str, hidden: tuple[int, ...]) -> str | None:
    """The learner that a learner is made of, by name: the modules of ``gated``; None for any other."""
    if learner != "gated":
        return None
    return "networks" if hidden else "table"
