"""Sentences that several captions share."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING

from upswing.study.task import Task
from upswing.study.wording import listed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from upswing.figures.decided import Decided
    from upswing.figures.three_and_all import Shown

ORDERED_BY_FALLS = (
    "The worst, the median and the best run by their number of falls (ties: falls in the last fifth, "
    "seed)"
)
ENSEMBLE = "thin lines are single runs, the thick line their median"
ANGLE_HISTOGRAM = (
    "where the pendulum was: the stronger the colour, the more of its steps at that angle and time"
)
ORDERED_BY_UPRIGHT = (
    "The worst, the median and the best run by their share of upright steps, |φ| ≤ 20°, in the last "
    "fifth (ties: mean reward, seed)"
)


def succeeding(tasks: Iterable[Task], when: Mapping[str, str]) -> str:
    """What a run does that succeeds, for the ways in which these tasks are judged.

    Args:
        tasks: those that are shown.
        when: the words for ``falls`` and for ``upright``.
    """
    judged_by = {task.judged_by for task in tasks}
    return ", or ".join(words for name, words in when.items() if name in judged_by)


def phases_named(shown: "Shown") -> str:
    """What the words on the picture mean; nothing where there are none."""
    from upswing.figures.phases import COLUMNS, SHORTEST, meaning

    if not shown.phases:
        return ""
    meant = "; ".join(meaning(name, shown.bodies) for name in shown.phases)
    least = f"{SHORTEST / COLUMNS:.0%}".replace("%", " %")
    return f" A word on the picture says what lasts for at least {least} of the run: {meant}."


def what_decides(shown: "Shown") -> str:
    """What the panels below the rows show, and of which claims the study lacks cells."""
    return claims_decided(shown.decided, shown.lacking)


def claims_decided(decided: "Sequence[Decided]", lacking: "Sequence[str]") -> str:
    """What panels that decide claims show, and of which claims the study lacks cells."""
    words = ""
    if decided:
        names = list(dict.fromkeys(one.claim for one in decided))
        words = (
            f" Below, what decides {listed(names)}: every run as a dot where each is measured, and at "
            "the right the estimate with its 95 % interval. A claim holds in the shaded part, and "
            "partly up to the dashed line."
        )
        if any(row.beside for one in decided for row in one.rows):
            words += (
                " Pale dots with a hollow estimate are other step sizes, for comparison: they decide "
                "nothing."
            )
    if lacking:
        words += f" Of {listed(lacking)} this study has not all cells."
    return words
