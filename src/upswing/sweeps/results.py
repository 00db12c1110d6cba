"""The tables of the sweeps: ``selection``, ``readings`` and what decides each claim."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from upswing.claims import Claim
from upswing.problems import BadInput
from upswing.store.ledger import seal
from upswing.study import read_study
from upswing.sweeps.names import DECISIVE, READINGS, ROBUST, SELECTION
from upswing.sweeps.plan import Sweep
from upswing.sweeps.read import read_sweep
from upswing.sweeps.robustness import decisive, robustness, summary
from upswing.sweeps.selection import SWEEP, select
from upswing.tables import write_table


def write_readings(
    results: Path, sweeps: Mapping[str, Sweep], claims: Mapping[str, Claim]
) -> pd.DataFrame:
    """Write the four tables of the sweeps below ``results``; returns that of the claims.

    Raises:
        BadInput: some of the sweeps' runs are missing.
    """
    study = read_study(results)
    if not sweeps:
        raise BadInput(
            [f"{results}: no sweep of the readings fits this study: it lacks their cells"]
        )
    runs = {name: read_sweep(results, name, sweep, study) for name, sweep in sweeps.items()}
    if SWEEP in runs:
        write_table(results / SELECTION, select(runs[SWEEP]))
    judged = robustness(sweeps, study, claims, runs)
    robust = summary(judged)
    write_table(results / READINGS, judged)
    write_table(results / DECISIVE, decisive(judged, sweeps))
    write_table(results / ROBUST, robust)
    tables = [results / table for table in (SELECTION, READINGS, DECISIVE, ROBUST)]
    seal(results, "readings", [path for path in tables if path.exists()])
    return robust
