"""What the figures that sum up know of a cell: how many of its runs succeed."""

from typing import NamedTuple

from upswing.analysis import statistics
from upswing.runs.results import Results
from upswing.runs.success import succeeds


class Share(NamedTuple):
    """The share of a cell's runs that succeed, in per cent."""

    value: float
    low: float
    high: float
    successes: int
    of: int


def share(results: Results, cell: str) -> Share:
    """How many runs of a cell succeed, with the 95 % interval of the share."""
    fulfilled = succeeds(results.counted(cell), results.task(cell))
    successes, of = int(fulfilled.sum()), len(fulfilled)
    estimate = statistics.share(successes, of)
    return Share(100 * estimate.value, 100 * estimate.low, 100 * estimate.high, successes, of)


def frequency(results: Results, cell: str) -> str:
    """How many of a cell's runs succeed, as a sentence."""
    found = share(results, cell)
    by_falls = results.task(cell).judged_by == "falls"
    done = "do not fall in their last fifth" if by_falls else "stand at the end"
    lost = len(results.cell(cell)) - found.of
    words = f"{found.successes} of {found.of} runs {done}"
    return f"{words}; {lost} more diverged." if lost else f"{words}."
