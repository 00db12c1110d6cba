"""What the columns of a run are called for readers, with units: in its recording and the catalog."""

from upswing.runs.endings import ENDINGS, PERCENT
from upswing.study.task import Task

LENGTHS = {
    "falls_first_5000": ("falls, first {:,} steps", 5_000),
    "falls_2500_to_5000": ("falls, step {:,} to {:,}", 2_500, 5_000),
    "upright_at_end": ("upright, last {:,} steps [share]", 100_000),
}
"""Columns that are of a length of their own, and the lengths [steps of 5 ms]."""


def _thesis_s(name: str) -> str:
    """What a column of ``LENGTHS`` is called where steps are of 5 ms."""
    words, *lengths = LENGTHS[name]
    return str(words).format(*lengths)


LABELS = {
    "task": "task",
    "architecture": "architecture",
    "alpha": "α",
    "seed": "seed",
    "steps": "steps",
    "falls": "falls",
    "falls_last_fifth": "falls, last fifth",
    "upright_share": "upright, last fifth [share]",
    "above_horizontal_share": "above horizontal, last fifth [share]",
    "mean_reward": "mean reward, last fifth [rad²]",
    "first_stable_step": "first stable [step]",
    "falls_first_5000": _thesis_s("falls_first_5000"),
    "falls_2500_to_5000": _thesis_s("falls_2500_to_5000"),
    "falls_after_stable": "falls after the first stable step",
    "swing_ups": "arrivals above horizontal",
    "swing_ups_last_fifth": "arrivals, last fifth",
    "arrival_speed": "speed on arriving [rad/s]",
    "too_fast_share": "too fast to stop [share of arrivals]",
    "too_fast_last_fifth": "too fast to stop, last fifth",
    "recovered_share": "got up again, last fifth [share of falls]",
    "upright_at_end": _thesis_s("upright_at_end"),
    "diverged_at": "diverged [step]",
    "greedy_success_share": "frozen: starts that succeed [share]",
    "greedy_upright_share": "frozen: upright [share]",
    "seconds": "time to learn [s]",
    "steps_per_second": "steps learned a second",
    "git_commit": "commit",
    "dirty": "with changes of its own",
    "digest": "digest",
    "spec": "specification",
    **{
        name.format(percent): f"{words}, last {percent} %{unit}"
        for name, (words, unit) in {
            "falls_last_{}": ("falls", ""),
            "upright_last_{}": ("upright", " [share]"),
            "mean_reward_last_{}": ("mean reward", " [rad²]"),
            "swing_ups_last_{}": ("arrivals", ""),
            "too_fast_last_{}": ("too fast to stop", ""),
            "recovered_last_{}": ("got up again", " [share of falls]"),
        }.items()
        for percent in PERCENT
    },
}
"""By the name of the column."""

OTHER_ENDINGS = tuple(
    dict.fromkeys(name.format(percent) for name in ENDINGS.values() for percent in PERCENT)
)
"""The measures over other endings than the last fifth, which few readers ask for."""


def label(name: str, task: Task) -> str:
    """What a column is called, for runs of a task; a measure that is new here by its own name."""
    if name in LENGTHS:  # the same time, in steps of the task's own
        words, *lengths = LENGTHS[name]
        return str(words).format(*(task.steps_of(int(length)) for length in lengths))
    return LABELS.get(name, name.replace("_", " "))
