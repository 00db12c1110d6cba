"""How the claims do over readings, for a study that has not swept them: what the project brings along.

``make readings`` takes forty minutes, so its result comes with the project, ``report/readings.json``,
which ``make readme`` renews. A claim that has been changed since is not what was judged there, and takes
nothing.
"""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from upswing.analysis.robustness.tables import (
    LEDGER_OF_READINGS,
    OF_A_SUMMARY,
    REMEDY,
    SHIPPED,
)
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import ledger_path, read_ledger
from upswing.runs.files.provenance import provenance
from upswing.runs.files.typed_table import read_table
from upswing.study.claims import Claim, canonical_claims
from upswing.study.errors import BadInput
from upswing.study.paths import ROBUST

NUMBERS = ("held_share", "weighted_share", "weighted_low", "weighted_high")

Row = dict[str, Any]


def write_shipped(
    results: Path, templates: Path, claims: Mapping[str, Claim], made_from: Mapping[str, str]
) -> None:
    """Keep what the sweeps of ``results`` came to; ``made_from`` says which sweeps and code they are."""
    rows = _own(results)
    content = {
        "made_from": {**made_from, "commit": provenance().git_commit},
        "claims": {
            claim: {**_plain(row), "judged": checksum_of(claims[claim])}
            for claim, row in rows.items()
            if claim in claims
        },
    }
    with written(templates / SHIPPED) as beside:
        beside.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", "utf-8")


def over_readings(
    results: Path, templates: Path, claims: Mapping[str, Claim]
) -> tuple[dict[str, Row], str]:
    """What the readings say of each claim, and where it is from: ``own``, ``shipped`` or nowhere.

    Of a claim that has been changed since it was judged there, they say nothing.

    Raises:
        BadInput: what is there cannot be read.
    """
    if (results / ROBUST).exists():
        changed = changed_claims(results, claims)
        return {name: row for name, row in _own(results).items() if name not in changed}, "own"
    found = read_shipped(templates)
    taken = {
        claim: row
        for claim, row in found.claims.items()
        if claim in claims and row["judged"] == checksum_of(claims[claim])
    }
    return taken, "shipped" if found.claims else ""


class Shipped(NamedTuple):
    """What the project brings along."""

    made_from: dict[str, str]
    claims: dict[str, Row]


def read_shipped(templates: Path) -> Shipped:
    """What ``make readme`` kept; nothing where it kept nothing.

    Raises:
        BadInput: the file is not what it writes.
    """
    path = templates / SHIPPED
    if not path.exists():
        return Shipped({}, {})
    try:
        content = json.loads(path.read_text("utf-8"))
        rows = {
            str(claim): {
                **row,
                "judged": str(row["judged"]),
                "grade": str(row["grade"]),
                **{name: _number(row[name]) for name in NUMBERS},
            }
            for claim, row in content["claims"].items()
        }
        return Shipped({str(k): str(v) for k, v in content["made_from"].items()}, rows)
    except (ValueError, KeyError, TypeError, AttributeError):
        raise BadInput([f"{path}: is not what `make readme` writes; it makes it anew"]) from None


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise TypeError(value)
    return float(value)


def checksum_of(claim: Claim) -> str:
    """What tells whether a claim is still the one that was judged."""
    return hashlib.sha256(canonical_claims({"C": claim}).encode()).hexdigest()[:16]


def changed_claims(results: Path, claims: Mapping[str, Claim]) -> list[str]:
    """The claims that are no longer those that a study's own sweeps were judged by."""
    try:
        judged = read_ledger(ledger_path(results, LEDGER_OF_READINGS)).made_from
    except BadInput:
        return []
    by = {name: judged.get(f"claim {name}") for name in claims}
    return [name for name, claim in claims.items() if by[name] not in (None, checksum_of(claim))]


def _own(results: Path) -> dict[str, Row]:
    frame: pd.DataFrame = read_table(results / ROBUST, OF_A_SUMMARY, REMEDY)
    rows = [{str(k): v for k, v in row.items()} for row in frame.to_dict("records")]
    return {str(row["claim"]): row for row in rows}


def _plain(row: Row) -> Row:
    """Rounded, so that a difference in the last digits is none."""
    return {
        name: round(value, 4) if isinstance(value, float) else value for name, value in row.items()
    }
