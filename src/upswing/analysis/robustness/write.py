"""The tables of the sweeps: ``selection``, ``readings`` and what decides each claim."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from upswing.analysis.robustness.judging import decisive, robustness, summary
from upswing.analysis.robustness.read import read_sweep
from upswing.analysis.robustness.selection import select
from upswing.analysis.robustness.shipped import checksum_of
from upswing.analysis.robustness.tables import LEDGER_OF_READINGS
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.runs.study_file import read_study
from upswing.study import jobs
from upswing.study.claims import Claim
from upswing.study.config import Study
from upswing.study.errors import BadInput
from upswing.study.paths import DECISIVE, READINGS, ROBUST, SELECTION, TILES
from upswing.study.sweeps import CHOOSING, Sweep


def write_readings(
    results: Path,
    sweeps: Mapping[str, Sweep],
    claims: Mapping[str, Claim],
    study: Study | None = None,
) -> pd.DataFrame:
    """Write the four tables of the sweeps below ``results``; returns that of the claims.

    Args:
        results: the folder of results.
        sweeps: the sweeps that the study has the cells for.
        claims: the claims that are judged.
        study: whose readings are varied; without it, the one that the folder is of.

    Raises:
        BadInput: some of the sweeps' runs are missing.
    """
    study = study or read_study(results)
    if not sweeps:
        raise BadInput(
            [f"{results}: no sweep of the readings fits this study: it lacks their cells"]
        )
    runs = {name: read_sweep(results, name, sweep, study) for name, sweep in sweeps.items()}
    if CHOOSING in runs:
        write_table(results / SELECTION, select(runs[CHOOSING], sweeps[CHOOSING].reports))
    judged = robustness(sweeps, study, claims, runs, _tiles(results))
    robust = summary(judged, sweeps, claims, runs)
    write_table(results / READINGS, judged)
    write_table(results / DECISIVE, decisive(judged, sweeps))
    write_table(results / ROBUST, robust)
    tables = [results / table for table in (SELECTION, READINGS, DECISIVE, ROBUST)]
    seal(
        results,
        LEDGER_OF_READINGS,
        [path for path in tables if path.exists()],
        code=jobs.JUDGED_OVER_READINGS.fingerprint,
        **{f"claim {name}": checksum_of(claim) for name, claim in claims.items()},
    )
    return robust


def _tiles(results: Path) -> pd.DataFrame:
    """What a policy on the tiles came to; no starts where no claim of the study asks."""
    if (results / TILES).exists():
        return Results(results).tile_policy
    return pd.DataFrame({"success": np.empty(0, dtype=bool)})
