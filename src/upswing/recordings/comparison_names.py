"""The names of the recordings that compare runs; light, so that the workflow can read it."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from upswing.study.claims import Claim
    from upswing.study.spec import Spec


def comparison_names(claims: "Mapping[str, Claim]", cells: "Mapping[str, Spec]") -> list[str]:
    """``task-…`` for each task, and ``claim-…`` for each claim whose cell the study has."""
    tasks = dict.fromkeys(cell.task.name for cell in cells.values())
    shown = [name for name, claim in claims.items() if claim.cell in cells]
    return [*(f"task-{task}" for task in tasks), *(f"claim-{claim}" for claim in shown)]
