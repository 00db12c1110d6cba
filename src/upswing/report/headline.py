"""What the page says first: a question and its answer, as the tables have it, and both in short."""

from typing import NamedTuple

from upswing.report.findings import Cells, Finding, learned

NEUTRAL = "Reinforcement Learning in Motor Control, reproduced"
QUESTION = "Can a pendulum learn to swing itself up and stay up?"
ANSWER = "Yes. A plain table can, with the right step size."


class Headline(NamedTuple):
    """The title of the page, and what somebody is told who gets a link to it."""

    question: str
    answer: str  # empty where the study does not answer
    description: str


def headline(cells: Cells, found: list[Finding], claims: int, runs: int) -> Headline:
    """The question and its answer where this study has one; else a title that promises none.

    Args:
        cells: the rows of the table of cells by their ids.
        found: what was found.
        claims: number of empirical claims that were judged.
        runs: number of runs.
    """
    held = f"{claims} claims of a thesis on Q-learning, held against {runs:,} new runs."
    told = " ".join([held, *(f"{one.number} {one.says}" for one in found[:1])])
    if learned(cells) is None:
        return Headline(NEUTRAL, "", told)
    return Headline(QUESTION, ANSWER, f"{QUESTION} {ANSWER} {told}")
