"""Which runs to browse: ``task=full-control seed=0..4``, ``claim=C13``, or a run's id."""

from collections.abc import Callable, Sequence

import pandas as pd

from upswing.runs.files.tables import read_verdicts
from upswing.runs.results import Results
from upswing.study.errors import BadInput, near
from upswing.study.ids import run_of
from upswing.study.names import alpha_text

KEYS = ("task", "architecture", "alpha", "seed", "claim")


def select(results: Results, words: Sequence[str]) -> pd.DataFrame:
    """The rows of the table of runs that fulfil every word; all runs for no word.

    Raises:
        BadInput: there are no results, a word is not understood, or nothing matches.
    """
    runs = results.runs
    for word in words:
        key, equals, value = word.partition("=")
        if not equals:
            chosen = _by_id(runs, word)
        elif key == "claim":
            chosen = runs[runs["recording"].isin(_of_claim(results, value))]
        elif key in KEYS:
            chosen = _by_value(runs, key, value)
        else:
            raise BadInput([f"filter: {word}: unknown key; {near(key, KEYS)}"])
        runs = chosen
    if runs.empty:
        raise BadInput([f"filter: {' '.join(words)}: no run fulfils all of it"])
    return runs


def _by_id(runs: pd.DataFrame, word: str) -> pd.DataFrame:
    """The run of an id or of a recording's path, or the runs of a cell or task."""
    parts = word.removesuffix(".rrd").strip("/").split("/")
    # A path is an id behind ``runs/``; but a task may be called so too.
    for first in (0, *(place + 1 for place, part in enumerate(parts) if part == "runs")):
        asked = "/".join(parts[first:])
        chosen = runs[(runs["run"] == asked) | runs["run"].str.startswith(f"{asked}/")]
        if not chosen.empty:
            return chosen
    raise BadInput([f"filter: {word}: no such run; {near(run_of(word), runs['run'])[:200]}"])


def _by_value(runs: pd.DataFrame, key: str, value: str) -> pd.DataFrame:
    texts = runs[key].map(_text_of(key))
    wanted = [part for item in value.split(",") for part in _range(item)]
    for part in wanted:
        if part not in set(texts):
            raise BadInput([f"filter: {key}={part}: no such run; {near(part, set(texts))[:200]}"])
    return runs[texts.isin(wanted)]


def _text_of(key: str) -> Callable[[object], str]:
    if key == "alpha":
        return lambda value: alpha_text(None if pd.isna(value) else float(value))  # type: ignore
    return str


def _range(item: str) -> list[str]:
    """``0..4`` as 0, 1, 2, 3, 4; anything else as itself."""
    first, dots, last = item.partition("..")
    if dots and first.isdigit() and last.isdigit():
        return [str(number) for number in range(int(first), int(last) + 1)]
    return [item]


def _of_claim(results: Results, claim: str) -> list[str]:
    """The recordings that show a claim: its worst, median and best run."""
    verdicts = read_verdicts(results.folder).set_index("claim")
    if claim not in verdicts.index:
        raise BadInput([f"filter: claim={claim}: no such claim; {near(claim, verdicts.index)}"])
    recordings = [str(path) for path in verdicts["recordings"].loc[claim]]
    if not recordings:
        raise BadInput([f"filter: claim={claim}: this claim is not about recorded runs"])
    return recordings
