"""What differs between the pendulums of a study's tasks, and the cells that it can be held against."""

from collections.abc import Iterable, Mapping
from itertools import takewhile
from typing import NamedTuple

from upswing.study.architecture import Architecture
from upswing.study.ids import CellId
from upswing.study.physical import PendulumOptions
from upswing.study.spec import Spec
from upswing.study.task import Task

UNITS = {
    "strongest push": ("m/s²", 1.0),
    "length": ("m", 1.0),
    "mass": ("kg", 1.0),
    "gravity": ("m/s²", 1.0),
    "friction": ("N·m·s", 1.0),
    "time step": ("ms", 1000.0),
}
"""The constants over which tasks can be drawn: their unit, and how many of it are one of the SI's."""


class Differing(NamedTuple):
    """A constant that differs between the pendulums of tasks."""

    name: str
    unit: str
    of: dict[str, float]  # its value by the task's name, in ascending order

    @property
    def words(self) -> str:
        """What an axis of it is called."""
        return f"{self.name} [{self.unit}]"


def constants(pendulum: PendulumOptions) -> dict[str, float]:
    """The constants of a pendulum that tasks can be drawn over, each in its unit."""
    push = min(abs(pendulum.accelerations[0]), abs(pendulum.accelerations[-1]))
    found = {
        "strongest push": push, "length": pendulum.length, "mass": pendulum.mass,
        "gravity": pendulum.gravity, "friction": pendulum.friction, "time step": pendulum.time_step,
    }  # fmt: skip
    return {name: float(f"{UNITS[name][1] * value:.12g}") for name, value in found.items()}


def differing(tasks: Mapping[str, Task]) -> Differing | None:
    """The first constant that is another in each of several tasks; None where there is none.

    A friction that was chosen for a length stands behind it in the order, and is no cause.
    """
    found = {name: constants(task.pendulum) for name, task in tasks.items()}
    for name in UNITS:
        values = {task: of[name] for task, of in found.items()}
        if len(values) > 1 and len(set(values.values())) == len(values):
            ordered = dict(sorted(values.items(), key=lambda pair: pair[1]))
            return Differing(name, UNITS[name][0], ordered)
    return None


class Line(NamedTuple):
    """Cells that are the same but for their pendulum."""

    label: str
    cells: dict[str, str]  # by their tasks, in the order of the constant


def lines(cells: Mapping[str, Spec], over: Differing) -> list[Line]:
    """The cells of these tasks in lines.

    A line is an architecture with a step size. Architectures that have one task each, and are the same
    but for their γ, are one line together: with a step of another length, another γ sees as far.
    """
    found: dict[str, dict[str, str]] = {}
    for cell, spec in cells.items():
        if spec.task.name in over.of and spec.alpha is not None:
            label = CellId.parse(cell).label
            found.setdefault(label, {})[spec.task.name] = cell
    single = {label: of for label, of in found.items() if len(of) == 1}
    groups: dict[str, list[str]] = {}
    for label, of in single.items():
        spec = cells[next(iter(of.values()))]
        groups.setdefault(f"{_without_discount(spec.architecture)} {spec.alpha}", []).append(label)
    for labels in groups.values():
        tasks = [next(iter(single[label])) for label in labels]
        if len(labels) > 1 and len(set(tasks)) == len(tasks):
            together = {
                task: found.pop(label)[task] for label, task in zip(labels, tasks, strict=True)
            }
            found[_named(cells[cell] for cell in together.values())] = together
    ordered = list(over.of)
    return [
        Line(label, dict(sorted(of.items(), key=lambda pair: ordered.index(pair[0]))))
        for label, of in found.items()
    ]


def _without_discount(architecture: Architecture) -> str:
    return str(architecture.model_dump_json(exclude={"discount", "name"}))


def _named(specs: Iterable[Spec]) -> str:
    """What a line of several architectures is called: what their names begin with alike."""
    several = list(specs)
    parts = zip(*(one.architecture.name.split("-") for one in several), strict=False)
    alike = "-".join(of[0] for of in takewhile(lambda of: len(set(of)) == 1, parts))
    own = CellId.parse(several[0].cell)
    return own.label.replace(own.architecture, alike or own.architecture)
