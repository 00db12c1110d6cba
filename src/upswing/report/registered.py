"""Whether what a page judges was written down before its runs: ``config/registration.yaml``."""

from pathlib import Path
from typing import Any

from upswing.report.own import is_chapter
from upswing.runs.files.ledger import ledger_path, read_ledger
from upswing.study.config import Study
from upswing.study.errors import BadInput
from upswing.study.paths import LEDGER_OF_VERDICTS
from upswing.study.project_files import along
from upswing.study.registration import (
    REGISTRATION,
    checksum_of,
    load_registration,
    of_chapter,
    seeds_of,
)

Row = dict[str, Any]


def registered(results: Path, study: Study) -> Row | None:
    """All entries, and what of these results is not as the last says; None where there are none."""
    registration = along(REGISTRATION)
    if not registration.exists():
        return None
    entries = load_registration(registration)
    entry = entries[-1]
    claims = _judged_by(results)
    if is_chapter(study):
        now = {"beyond": of_chapter(study, claims)}
    else:
        now = {
            "seeds": seeds_of(study),
            "readings": checksum_of(study.readings.model_dump_json()),
            "claims": checksum_of(claims) if claims else "",
        }
    changed = [name for name, value in now.items() if getattr(entry.registered, name) != value]
    told = [{"date": one.date, "unseen": one.unseen, "why": one.why} for one in entries]
    return {"date": entry.date, "changed": changed, "entries": told}


def _judged_by(results: Path) -> str:
    """The claims that the verdicts were made from, in canonical form; empty where that is unknown."""
    try:
        return str(read_ledger(ledger_path(results, LEDGER_OF_VERDICTS)).made_from["claims"])
    except (BadInput, KeyError):
        return ""
