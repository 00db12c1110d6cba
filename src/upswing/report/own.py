"""What the page of a study of one's own says where that of the thesis speaks of the thesis.

A study is one's own if it has a title or claims of its own, or if no claim is judged by it. What a page
says of the thesis's author is then left out; so is all of claims and verdicts, where none are judged.
"""

from collections.abc import Mapping, Sequence
from pathlib import PurePosixPath
from typing import Any

from upswing.analysis import statistics
from upswing.report.findings import Finding
from upswing.report.glossary import Word
from upswing.report.headline import Headline
from upswing.report.words import alpha, capital
from upswing.study.claim_parts import NOT_HERE
from upswing.study.config import Study, narrowed
from upswing.study.paths import BEYOND
from upswing.study.wording import listed

Row = dict[str, Any]

FEW = 3
"""So many names stand in a title; more are counted."""

OVER_READINGS = "over-readings"
OF_VERDICTS = (OVER_READINGS, "at-least-partly", "at-threshold", "fragile", "check")
OF_FALLS = ("balancing", "balances")
OF_UPRIGHT = ("full-control", "stands")
"""Words that say nothing where there are no verdicts, or no such task."""


def shown_verdicts(verdicts: Sequence[Row], study: Study) -> list[Row]:
    """The verdicts that a page shows: none where the study judges nothing, or no claim has its cells.

    What is judged of no cell, such as a theorem, is then judged by no run of this study either.
    """
    here = [row for row in verdicts if row["verdict"] != NOT_HERE and row["cells"]]
    return list(verdicts) if study.judges and here else []


def is_own(study: Study, verdicts: Sequence[Row]) -> bool:
    """Whether the page is about a study of one's own, given the verdicts that it shows.

    It has a title, or claims of its own, or no claim is judged by it.

    The study beyond the thesis, which has a folder of that name, is the thesis's chapter.
    """
    return not is_chapter(study) and bool(study.title or study.claims or not verdicts)


def is_chapter(study: Study) -> bool:
    """Whether a study is the chapter beyond the thesis: changes to it, in the folder for them."""
    changes = any(one.title for one in study.experiments)
    return changes and not study.title and PurePosixPath(study.results).name == BEYOND


def title_of(study: Study) -> str:
    """The study's own title, or one made of what learns at what."""
    if study.title:
        return study.title
    named = [name for one in study.experiments for name in one.architectures]
    learning = [name for name in dict.fromkeys(named) if study.architectures[name].learns]
    tasks = list(dict.fromkeys(name for one in study.experiments for name in one.tasks))
    what = _named(learning, "architectures") if learning else "nothing that learns"
    return f"{what[:1].upper()}{what[1:]} at {_named(tasks, 'tasks')}"


def _named(names: Sequence[str], kind: str) -> str:
    return listed(names) if len(names) <= FEW else f"{len(names)} {kind}"


def own_headline(study: Study, told: str) -> Headline:
    """The title of its page, and what somebody is told who gets a link to it.

    Args:
        study: the study.
        told: how much it ran (``counted``).
    """
    judges = "" if study.judges else ", too little to judge anything by"
    return Headline(title_of(study), "", f"{study.about} {capital(told)}{judges}.".strip())


def counted(cells: int, runs: int, of_each: str) -> str:
    """How much was run: ``20 runs, 5 of each of 4 settings``."""
    return (
        f"{runs:,} runs, {of_each} of {f'each of {cells} settings' if cells > 1 else 'one setting'}"
    )


def own_findings(cells: Sequence[Row], study: Study) -> list[Finding]:
    """For each of a few tasks, the cell in which most runs succeed; none where nothing is judged."""
    learning = [
        row for row in cells
        if row["architecture"] in study.architectures
        and study.architectures[row["architecture"]].learns and row["runs"]
    ]  # fmt: skip
    tasks = list(dict.fromkeys(row["task"] for row in learning))
    if not study.judges or len(tasks) > FEW:
        return []
    found = []
    for task in tasks:
        own = [row for row in learning if row["task"] == task]
        best = max(own, key=lambda row: succeeding(row, study) / row["runs"])
        number, runs = succeeding(best, study), int(best["runs"])
        done = (
            "balance to the end" if study.tasks[task].judged_by == "falls" else "stand at the end"
        )
        of = f", the best of {len(own)} settings" if len(own) > 1 else ""
        share = statistics.share(number, runs)
        found.append(
            Finding(
                f"{number} of {runs}",
                f"runs of {task} {done} with {best['architecture']}, α = {alpha(best['alpha'])}{of}.",
                f"95 % interval of this share: {share.low:.2f} to {share.high:.2f}",
                f"cell-{best['cell']}",
            )
        )
    return found


def succeeding(row: Row, study: Study) -> int:
    """How many runs of a cell succeed."""
    falls = study.tasks[row["task"]].judged_by == "falls"
    return int(row["runs_without_fall_in_last_fifth" if falls else "runs_upright_at_end"])


def own_words(
    words: Mapping[str, Word], study: Study, lengths: Mapping[str, str], step: str, judged: bool
) -> dict[str, Word]:
    """The glossary of a study of one's own: lengths are its own, and what it has not is left out.

    Args:
        words: that of the thesis's study.
        study: the study.
        lengths: how long full control is judged (``pendulums.lengths``).
        step: how long a step is.
        judged: whether the page shows verdicts; readings are asked of the thesis's claims alone.
    """
    used = narrowed(study)
    judged_by = {task.judged_by for task in used.tasks.values()}
    gone = {
        *((OVER_READINGS,) if judged else OF_VERDICTS),
        *(() if "falls" in judged_by else OF_FALLS),
        *(() if "upright" in judged_by else OF_UPRIGHT),
        *(("control",) if all(one.learns for one in used.architectures.values()) else ()),
    }
    own = {"step": ("5 ms", step), "diverged": (COUNTS_NOWHERE, "It is left out of all numbers.")}
    if lengths["end"] != "100,000 steps" or step != "5 ms":
        own["stands"] = ("100,000 steps (8 minutes)", lengths["end"])
    if step != "5 ms":
        stable = lengths["stable"]
        own["stable"] = ("5,000 steps (25 s)", f"{stable} (25 s)" if "steps" in stable else stable)
    return {
        key: word.model_copy(update={"meaning": word.meaning.replace(*own[key])}) if key in own else word
        for key, word in words.items()
        if key not in gone
    }  # fmt: skip


COUNTS_NOWHERE = "It counts neither for nor against any claim."
