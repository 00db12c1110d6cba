"""Reading a sweep back: one row a run, under whichever readings."""

from pathlib import Path

import pandas as pd

from upswing.config import Study
from upswing.problems import BadInput
from upswing.sweeps.plan import Sweep, groups
from upswing.sweeps.sweep import path_of


def read_sweep(results: Path, name: str, sweep: Sweep, study: Study) -> pd.DataFrame:
    """The rows of all groups of a sweep; ``BadInput`` names what is missing."""
    paths = [path_of(results, name, group.name) for group in groups(sweep, study)]
    if missing := [path for path in paths if not path.is_file()]:
        raise BadInput(
            [f"{missing[0]}: missing ({len(missing)} of {len(paths)}); `make readings` makes them"]
        )
    return pd.concat([pd.read_parquet(path) for path in paths], ignore_index=True)
