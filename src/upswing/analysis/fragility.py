"""Would the verdict have been another with another window, or with half of the seeds?

A verdict that turns with either is *fragile*, and the page says why beside it. The windows are the last
5, 10, 20 and 30 % of a run in place of its last fifth or its last 100,000 steps; the halves are every
other seed.
"""

from collections.abc import Callable, Iterator, Mapping

import pandas as pd

from upswing.runs.endings import ENDINGS, PERCENT
from upswing.runs.results import Results

LAST_FIFTH = 20

Verdicts = Callable[[Results], Mapping[str, str]]
"""The verdict on each claim."""


class Seen(Results):
    """The same results with the rows of each cell changed."""

    def __init__(self, results: Results, change: Callable[[pd.DataFrame], pd.DataFrame]) -> None:
        super().__init__(results.folder)
        self.results, self.change = results, change
        self.__dict__.update(study=results.study, cells=results.cells)
        self._changed: dict[str, pd.DataFrame] = {}

    def cell(self, cell: str) -> pd.DataFrame:
        """The rows of a cell's runs, changed."""
        if cell not in self._changed:
            self._changed[cell] = self.change(self.results.cell(cell))
        return self._changed[cell]

    @property
    def tile_policy(self) -> pd.DataFrame:
        """What does not depend on runs."""
        return self.results.tile_policy


def over_ending(percent: int) -> Callable[[pd.DataFrame], pd.DataFrame]:
    """Rows of runs as if their last ``percent`` were what is looked at."""

    def change(runs: pd.DataFrame) -> pd.DataFrame:
        names = {measure: name.format(percent) for measure, name in ENDINGS.items()}
        if percent == LAST_FIFTH:  # it is measured over it already, with what is under way
            del names["recovered_share"]
        return runs.assign(
            **{measure: runs[name] for measure, name in names.items() if name in runs}
        )

    return change


def half(number: int) -> Callable[[pd.DataFrame], pd.DataFrame]:
    """Every other run, by seed: the first half (0) or the second (1)."""
    return lambda runs: runs.sort_values("seed").iloc[number::2]


def fragile_because(
    results: Results, whole: Mapping[str, str], verdicts_of: Verdicts
) -> dict[str, list[str]]:
    """For each claim why its verdict is fragile; nothing for one that is not.

    Args:
        results: the runs.
        whole: the verdict on each claim by all of them.
        verdicts_of: judges them by others.
    """
    found: dict[str, list[str]] = {name: [] for name in whole}
    for words, seen in _views(results):
        other = verdicts_of(seen)
        for name in whole:
            if other[name] != whole[name]:
                found[name].append(f"{words}: {other[name]}")
    return found


def _views(results: Results) -> Iterator[tuple[str, Results]]:
    for percent in PERCENT:
        yield f"over the last {percent} %", Seen(results, over_ending(percent))
    for number, words in enumerate(("one half of its seeds", "the other half")):
        yield words, Seen(results, half(number))
