"""Parts that are chosen by the name of their file, as tasks, learners and figures are.

They are imported when they are needed, so that a table never waits for torch.
"""

from importlib import import_module
from pathlib import Path
from typing import Any

PACKAGES = {
    "tasks": "upswing.physics.tasks",
    "features": "upswing.agents.features",
    "learners": "upswing.agents.learners",
    "algorithms": "upswing.agents.algorithms",
    "figures": "upswing.figures",
}
"""Where the parts of each kind lie."""

MARKS = {"figures": "\nFIGURE = "}
"""What a file has that is a part, where others lie beside it."""

COMPILED = ("features", "learners", "algorithms", "tasks")
"""The kinds whose parts hold compiled code."""

SOURCE = Path(__file__).parents[2]
"""The folder of this package."""


def module_of(kind: str, name: str) -> str:
    """The module of a part by its kind and its name in the configuration."""
    return f"{PACKAGES[kind]}.{name.replace('-', '_')}"


def parts(kind: str) -> list[str]:
    """The names of the parts of a kind: what there is to choose from."""
    place = SOURCE.joinpath(*PACKAGES[kind].split("."))
    files = place.glob("[a-z]*.py")
    if mark := MARKS.get(kind):
        files = (path for path in files if mark in path.read_text("utf-8"))
    names = (path.stem for path in files)
    return sorted(name.replace("_", "-") for name in names)


def source_of(kind: str, name: str) -> Path:
    """The file of a part."""
    return SOURCE.joinpath(*module_of(kind, name).split(".")).with_suffix(".py")


def load(kind: str, name: str) -> Any:
    """The module itself."""
    return import_module(module_of(kind, name))


def compiled_modules() -> list[str]:
    """Where compiled code starts from: the loop, the measures, dynamic programming, and every part."""
    named = [module_of(kind, name) for kind in COMPILED for name in parts(kind)]
    optimal = sorted((SOURCE / "upswing/optimal").glob("[a-z]*.py"))
    return [
        "upswing.runs.loop",
        "upswing.runs.metrics",
        *named,
        *(f"upswing.optimal.{path.stem}" for path in optimal),
    ]
