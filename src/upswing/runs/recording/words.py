"""A recording in words: what one sees, what the colours mean, and what happened in this run."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from upswing.physics.pendulum import Pendulum
from upswing.runs.metrics import END, STABLE_STEPS, last_fifth
from upswing.runs.recording.axes import MODULES
from upswing.runs.recording.frames import REAL_TIME, Frames
from upswing.runs.recording.labels import OTHER_ENDINGS, label
from upswing.runs.success import SUCCESS
from upswing.study.measured import Measures
from upswing.study.names import alpha_text
from upswing.study.spec import Spec
from upswing.study.task import Task

NOT_TOLD = {"spec", "digest", "task", "architecture", "alpha", "seed", *OTHER_ENDINGS}
"""Properties that the table of numbers leaves out: they are told above, or few ask for them."""

COLOURS = """\
**Pendulum**: seen from the cart. The green rod is the pendulum, the orange arrow the cart's
acceleration; the marks on the ground are 10 cm apart and pass as the cart drives.

**Policy**: the greedy action in each tile of angle φ (to the right, 0 is upright) and angular velocity φ̇
(upwards). Blue accelerates the cart by −10 m/s², pale by 0, orange by +10 m/s²; dark grey is undecided.
{modules}The black dot is the state, its tail the last half second.

**Value**: the reward to come, as the learner believes. Yellow is 0, the best; purple is the lowest of
this run.

**Angle**: grey lines are the lowest and the highest angle over the whole run, on the timelines `step`
and `sim_time`."""

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
    modules = TWO_MODULES.format(*MODULES) if architecture.is_modular else ""
    numbers = "\n".join(
        f"| {label(name)} | {_brief(value)} |"
        for name, value in properties.items()
        if value is not None and name not in NOT_TOLD
    )
    return f"""\
### {task.name}: {architecture.name}{alpha}, seed {seed}

{story(task, measures, last_fall)}

{_of_frames(frames)}

{COLOURS.format(modules=modules)}

**{architecture.name}**: {architecture.in_words()}. Of 100 actions {100 * spec.epsilon:g} are random; the
discount γ is {spec.discount:g}.

| | |
| --- | --- |
{numbers}
"""


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
    seconds = STABLE_STEPS * Pendulum().time_step
    stable = f"{STABLE_STEPS:,} steps ({seconds:g} s)"
    kept = "without a fall" if by_falls else f"with {SUCCESS:.0%} of them upright"
    if measures.first_stable_step is None:
        stood = f"It was never stable: there are no {stable} {kept}."
    else:
        first = f"{measures.first_stable_step:,}"
        stood = f"It was stable for the first time from step {first}: {stable} {kept}."
    if by_falls:
        ended = measures.falls_last_fifth
        end = f"{fell}, and {ended:,} times in its last fifth: **it does not balance**."
        if not ended:
            end = f"{fell}, and not once in its last fifth: **it balances**."
    else:
        last = measures.steps - max(last_fifth(measures.steps), measures.steps - END)
        stands = "stands" if measures.upright_at_end >= SUCCESS else "does not stand"
        end = (
            f"{fell}, and was upright for {100 * measures.upright_at_end:.3g} % of its last {last:,} "
            f"steps: **it {stands} at the end**."
        )
    return f"{stood} {end}"


def _of_frames(frames: Frames) -> str:
    """What is shown when, and how fast."""
    begins = frames.at(np.array([part.first for part in frames.named], dtype=np.int64))
    rows = "\n".join(
        f"| {part.name} | {begin:,} | {part.first:,} to {part.after - 1:,} |"
        for part, begin in zip(frames.named, begins.tolist(), strict=True)
    )
    return f"""\
The timeline `frame` plays these stretches, one after another, at **{REAL_TIME:g} frames a second: as
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
