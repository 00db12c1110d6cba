"""A recording in words: what one sees, what the colours mean, and what happened in this run."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from upswing.physics.actions import signed
from upswing.runs.metrics import END, STABLE_STEPS, last_fifth
from upswing.runs.recording.axes import MODULES
from upswing.runs.recording.frames import Frames, real_time
from upswing.runs.recording.labels import OTHER_ENDINGS, label
from upswing.runs.recording.sizes import in_words, marks_apart
from upswing.runs.success import SUCCESS
from upswing.study.measured import Measures
from upswing.study.names import alpha_text
from upswing.study.spec import Spec
from upswing.study.task import Task

NOT_TOLD = {"spec", "digest", "task", "architecture", "alpha", "seed", *OTHER_ENDINGS}
"""Properties that the table of numbers leaves out: they are told above, or few ask for them."""

COLOURS = """\
**Pendulum**: seen from the cart. The green rod is the pendulum, the orange arrow the cart's
acceleration; the marks on the ground are {marks} apart and pass as the cart drives.{track}

**Policy**: the greedy action in each tile of angle φ (to the right, 0 is upright) and angular velocity φ̇
(upwards). {actions}; dark grey is undecided.
{modules}The black dot is the state, its tail the last half second.

**Value**: the reward to come, as the learner believes. Yellow is 0, the best; purple is the lowest of
this run.

**Angle**: grey lines are the lowest and the highest angle over the whole run, on the timelines `step`
and `sim_time`."""

ENDS = " The posts are the ends of the track, {limit:g} m from its middle."

TWO_MODULES = "Paler colours are of the module for {}, darker ones of that for {}. "


def about(
    spec: Spec,
    seed: int,
    measures: Measures,
    last_fall: int | None,
    frames: Frames,
    properties: Mapping[str, Any],
) -> str:
    """The text of a run's recording, in Markdown.

    Args:
        spec: the cell.
        seed: which run of it.
        measures: what the run came to.
        last_fall: the step of its last fall; None if it never fell.
        frames: what the recording shows.
        properties: the numbers that stand below, by their names; None is unknown.
    """
    task, architecture = spec.task, spec.architecture
    alpha = "" if spec.alpha is None else f", step size α = {alpha_text(spec.alpha)}"
    numbers = "\n".join(
        f"| {label(name, task)} | {_brief(value)} |"
        for name, value in properties.items()
        if value is not None and name not in NOT_TOLD
    )
    return f"""\
### {task.name}: {architecture.name}{alpha}, seed {seed}

{story(task, measures, last_fall)}

{_of_frames(frames)}

{colours(spec)}

**{architecture.name}**: {architecture.in_words()}. {_of_choosing(spec)}; the
discount γ is {spec.discount:g}.

| | |
| --- | --- |
{numbers}
"""


def _of_choosing(spec: Spec) -> str:
    """How actions are chosen."""
    if spec.architecture.holds == "policy":
        return "Actions are drawn by the probabilities that it has learned"
    return f"Of 100 actions {100 * spec.epsilon:g} are random"


def story(task: Task, measures: Measures, last_fall: int | None) -> str:
    """What happened in a run, in two sentences."""
    by_falls = task.judged_by == "falls"
    steps = f"{measures.steps:,}"
    if measures.falls == 0:
        fell = "It never fell"
    else:
        times = "once" if measures.falls == 1 else f"{measures.falls:,} times"
        at = "" if last_fall is None else f", the last time at step {last_fall:,} of {steps}"
        fell = f"It fell {times}{at}"
    if measures.diverged_at is not None:
        return (
            f"**It diverged at step {measures.diverged_at:,} of {steps}**: a value was no finite number "
            f"any more, and nothing after it means anything. {fell}; the run counts neither for nor "
            "against anything."
        )
    length = task.steps_of(STABLE_STEPS)
    stable = f"{length:,} steps ({length * task.pendulum.time_step:g} s)"
    kept = "without a fall" if by_falls else f"with {100 * SUCCESS:.0f} % of them upright"
    if measures.first_stable_step is None:
        stood = f"It was never stable: there are no {stable} {kept}."
    else:
        first = f"{measures.first_stable_step:,}"
        stood = f"It was stable for the first time from step {first}: {stable} {kept}."
    if by_falls:
        ended = measures.falls_last_fifth
        often = "once" if ended == 1 else f"{ended:,} times"
        end = f"{fell}, and {often} in its last fifth: **it does not balance**."
        if not ended:
            end = f"{fell}, and not once in its last fifth: **it balances**."
    else:
        last = measures.steps - max(last_fifth(measures.steps), measures.steps - task.steps_of(END))
        stands = "stands" if measures.upright_at_end >= SUCCESS else "does not stand"
        end = (
            f"{fell}, and was upright for {100 * measures.upright_at_end:.3g} % of its last {last:,} "
            f"steps: **it {stands} at the end**."
        )
    return f"{stood} {end}"


def colours(spec: Spec) -> str:
    """What one sees of a run and what its colours mean, in Markdown."""
    pendulum, track = spec.task.pendulum, spec.task.track.limit
    return COLOURS.format(
        marks=in_words(marks_apart(pendulum.length)),
        track="" if track is None else ENDS.format(limit=track),
        actions=_of_actions(pendulum.accelerations),
        modules=TWO_MODULES.format(*MODULES) if spec.architecture.is_modular else "",
    )


def _of_actions(accelerations: tuple[float, ...]) -> str:
    """What the colours of actions mean; accelerations in m/s²."""
    left, right = signed(accelerations[0]), signed(accelerations[-1])
    none = "pale by 0, " if 0 in accelerations else ""
    between = len(accelerations) - (3 if none else 2)
    others = ", and what is between by less: the paler, the less" if between else ""
    return f"Blue accelerates the cart by {left} m/s², {none}orange by {right} m/s²{others}"


def _of_frames(frames: Frames) -> str:
    """What is shown when, and how fast."""
    begins = frames.at(np.array([part.first for part in frames.named], dtype=np.int64))
    rows = "\n".join(
        f"| {part.name} | {begin:,} | {part.first:,} to {part.after - 1:,} |"
        for part, begin in zip(frames.named, begins.tolist(), strict=True)
    )
    speed = f"{real_time(frames.time_step):g} frames a second"
    return f"""\
The timeline `frame` plays these stretches, one after another, at **{speed}: as
fast as it happened**. The speed stands at the bottom, beside the timeline, and can be changed there.

| stretch | from frame | steps |
| --- | ---: | ---: |
{rows}

*Worst* is where it fell most often, or else earned least; *first stable* begins shortly before it was
first stable."""


def _brief(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return (
        f"{value:,.4g}"
        if isinstance(value, float)
        else f"{value:,}"
        if isinstance(value, int)
        else str(value)
    )
