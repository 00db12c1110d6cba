"""What a job of a sweep is made from, as the ledger beside its table keeps it."""

from collections.abc import Mapping

from upswing.study.config import Study
from upswing.study.spec import Spec
from upswing.study.sweeps import Group, Sweep, content_of


def ledger_of_group(sweep: str, group: str) -> str:
    """The name of the ledger of a group's table."""
    return f"readings/{sweep}/{group}"


def swept_from(
    sweep: Sweep, study: Study, group: Group, cells: Mapping[str, Spec], code: str
) -> dict[str, str]:
    """What a group's table depends on: the ``code`` that runs the sweep, and what it is asked for.

    ``cells`` are those of the study, and ``code`` is a fingerprint.
    """
    return {"code": code, "content": content_of(sweep, study, group, cells)}
