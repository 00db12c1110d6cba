"""Reading a sweep back: one row a run, under whichever readings."""

from pathlib import Path

import pandas as pd

from upswing.runs.files.typed_table import read_table
from upswing.runs.sweep import OF_A_SWEPT_RUN, path_of
from upswing.study.config import Study
from upswing.study.errors import BadInput
from upswing.study.sweeps import Sweep, canonical_of, groups


def read_sweep(results: Path, name: str, sweep: Sweep, study: Study) -> pd.DataFrame:
    """The rows of all groups of a sweep; ``BadInput`` names what is missing."""
    paths = [path_of(results, name, group.name) for group in groups(sweep, study)]
    if missing := [path for path in paths if not path.is_file()]:
        raise BadInput(
            [f"{missing[0]}: missing ({len(missing)} of {len(paths)}); `make readings` makes them"]
        )
    return pd.concat([_of_group(path, name, sweep, study) for path in paths], ignore_index=True)


def _of_group(path: Path, name: str, sweep: Sweep, study: Study) -> pd.DataFrame:
    """The rows of a group; ``BadInput`` if they are of another sweep."""
    remedy = "delete it, and `make readings` makes it anew"
    frame = read_table(path, OF_A_SWEPT_RUN, remedy)
    known = {group.name: group for group in groups(sweep, study)}[path.stem]
    asked = {canonical_of(overrides) for overrides in known.members}
    if set(frame["sweep"]) != {name} or set(frame["readings"]) != asked:
        raise BadInput([f"{path}: has rows of another sweep or of other readings; {remedy}"])
    return frame
