"""Reading a sweep back: one row a run, under whichever readings."""

from math import inf
from pathlib import Path

import pandas as pd

from upswing.runs.files.typed_table import read_table
from upswing.runs.sweep import OF_A_SWEPT_RUN, path_of, read_finalists
from upswing.study.config import Study
from upswing.study.errors import BadInput
from upswing.study.sweeps import Group, Sweep, canonical_of, groups


def read_sweep(
    results: Path, name: str, sweep: Sweep, study: Study, before: float = inf
) -> pd.DataFrame:
    """The rows of all groups of a sweep, or of its rounds ``before`` one.

    Raises:
        BadInput: some are missing, or are of another sweep; it names one.
    """
    asked = [group for group in groups(sweep, study) if group.round < before]
    paths = [path_of(results, name, group.name) for group in asked]
    if missing := [path for path in paths if not path.is_file()]:
        raise BadInput(
            [f"{missing[0]}: missing ({len(missing)} of {len(paths)}); `make readings` makes them"]
        )
    return pd.concat([_of_group(results, name, group) for group in asked], ignore_index=True)


def _of_group(results: Path, name: str, group: Group) -> pd.DataFrame:
    """The rows of a group; ``BadInput`` if they are of another sweep."""
    path, remedy = (
        path_of(results, name, group.name),
        "delete it, and `make readings` makes it anew",
    )
    frame = read_table(path, OF_A_SWEPT_RUN, remedy)
    members = group.members or read_finalists(results, name, group.round)
    asked = {canonical_of(overrides) for overrides in members}
    if set(frame["sweep"]) != {name} or set(frame["readings"]) != asked:
        raise BadInput([f"{path}: has rows of another sweep or of other readings; {remedy}"])
    return frame
