"""The names of recordings; light, so that the workflow and the report can read it."""

import sys
from collections.abc import Mapping
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from upswing.study.claims import Claim
    from upswing.study.spec import Spec


def _viewer() -> Path:
    found = find_spec("rerun_cli")
    if found is None or found.origin is None:
        return Path(sys.executable).with_name("rerun")
    folder = Path(found.origin).parent
    bundled = folder / "Rerun.app/Contents/MacOS/Rerun"
    return bundled if bundled.exists() else folder / "rerun"


VIEWER = _viewer()
"""Rerun's program itself. ``bin/rerun`` starts it as a second process, which outlives the first."""


def comparison_names(claims: "Mapping[str, Claim]", cells: "Mapping[str, Spec]") -> list[str]:
    """``task-…`` for each task, and ``claim-…`` for each claim whose cell the study has."""
    tasks = dict.fromkeys(cell.task.name for cell in cells.values())
    shown = [name for name, claim in claims.items() if claim.cell in cells]
    return [*(f"task-{task}" for task in tasks), *(f"claim-{claim}" for claim in shown)]
