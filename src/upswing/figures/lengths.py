"""Lengths of time and tiles in words, as a task has them where it is not the thesis's."""

from collections.abc import Iterable

from upswing.study.physical import THESIS_TIME_STEP
from upswing.study.spec import Spec
from upswing.study.task import Task


def step_label(tasks: Iterable[Task]) -> str:
    """What a step is in these tasks: ``step of 5 ms``; ``step``, where they differ in it."""
    lengths = {float(task.pendulum.time_step) for task in tasks}
    return f"step of {1000 * lengths.pop():g} ms" if len(lengths) == 1 else "step"


def in_steps(steps: int, tasks: Iterable[Task]) -> str:
    """Steps of the thesis as steps of these tasks, ``5,000 steps``; a time, where they differ."""
    found = {task.steps_of(steps) for task in tasks} or {steps}
    return f"{found.pop():,} steps" if len(found) == 1 else f"{steps * THESIS_TIME_STEP:g} s"


def end_of(tasks: Iterable[Task]) -> str:
    """The last steps by which full control is judged, behind "the last": ``100,000 steps``.

    Of a short run it is the last fifth, and of runs some of which are short, whichever is shorter.
    """
    from upswing.runs.metrics import END, last_fifth

    found = list(tasks)
    upright = [task for task in found if task.judged_by == "upright"] or found
    if not upright:
        return in_steps(END, ())
    fifths = {task.steps - last_fifth(task.steps) for task in upright}
    ends = {min(task.steps_of(END), task.steps - last_fifth(task.steps)) for task in upright}
    if len(ends) == 1:
        return f"{ends.pop():,} steps"
    if ends == fifths:
        return "fifth"
    most = in_steps(END, upright)
    is_whole = all(task.steps_of(END) <= task.steps - last_fifth(task.steps) for task in upright)
    return most if is_whole else f"fifth or {most}, whichever is shorter"


def grid_of(spec: Spec) -> str:
    """The parts of φ and φ̇ of a table, ``8 × 20``; of one of its modules, if it has several."""
    from upswing.agents.features.grid import tiles_for
    from upswing.physics import tasks as kinds

    task = kinds.create(spec.task.kind, spec.readings, spec.task.model_dump())
    modular = spec.architecture.is_modular
    tiles = tiles_for(task, modular, spec.readings, spec.task.tiles)
    return f"{tiles.angle_parts // tiles.modules} × {tiles.velocity_parts}"
