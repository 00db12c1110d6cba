"""Whether what the sweeps came to is of the code, the settings and the claims as they are now.

Sweeps take long, and only ``make readings`` renews them. So a study may have been run again, by newer
code, beside sweeps of an older one, and whoever shows these has to say so.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import pyarrow.parquet as pq

from upswing.analysis.robustness.shipped import changed_claims
from upswing.analysis.robustness.tables import LEDGER_OF_READINGS
from upswing.runs.files.ledger import ledger_path, read_ledger
from upswing.runs.files.provenance import KEY
from upswing.study import jobs
from upswing.study.claims import Claim
from upswing.study.config import Study
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.paths import ROBUST
from upswing.study.sweeps import Sweep, groups
from upswing.study.swept_from import ledger_of_group, swept_from


class Outdated(NamedTuple):
    """What has changed since the sweeps were run and judged."""

    commit: str  # of the judgement that is there
    changed: list[str]  # in words; empty if it is of everything as it is


def outdated(
    results: Path, sweeps: Mapping[str, Sweep], claims: Mapping[str, Claim], study: Study
) -> Outdated:
    """What of a judgement that is there ``make readings`` would make anew, and why."""
    other = [name for name, sweep in sweeps.items() if not _as_now(results, name, sweep, study)]
    changed = []
    if other:
        changed.append(f"the sweep{'s' * (len(other) > 1)} of {' and '.join(other)}")
    if _made_from(results, LEDGER_OF_READINGS).get("code") != jobs.JUDGED_OVER_READINGS.fingerprint:
        changed.append("the code that judges")
    changed += changed_claims(results, claims)
    return Outdated(_commit(results / ROBUST), changed)


def _as_now(results: Path, name: str, sweep: Sweep, study: Study) -> bool:
    """Whether every job of a sweep was run by this code, with these settings."""
    code, cells = jobs.sweep(sweep, study).fingerprint, Matrix(study).cells
    return all(
        _made_from(results, ledger_of_group(name, group.name))
        == swept_from(sweep, study, group, cells, code)
        for group in groups(sweep, study)
    )


def _made_from(results: Path, ledger: str) -> Mapping[str, str]:
    """What a ledger says that its files were made from; nothing if it cannot be read."""
    try:
        return read_ledger(ledger_path(results, ledger)).made_from
    except BadInput:
        return {}


def _commit(table: Path) -> str:
    """The commit that a table was written by."""
    try:
        return str(json.loads(pq.read_schema(table).metadata[KEY])["provenance"]["git_commit"])
    except (OSError, ValueError, KeyError, TypeError):
        return "unknown"
