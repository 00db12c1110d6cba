"""What was written down before the runs that it judges: ``config/registration.yaml``.

Each entry says when claims, sweeps or seeds became what they are, why, and which seeds no run had used
by then. So whoever changes a threshold after having seen a result has to say so, beside it.
"""

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

from pydantic import BeforeValidator, Field, ValidationError

from upswing.study.claims import Claim, canonical_claims
from upswing.study.config import Study
from upswing.study.errors import BadInput, explained
from upswing.study.matrix import Matrix
from upswing.study.names import Text
from upswing.study.sweeps import Sweep
from upswing.study.values import Strict, listed
from upswing.study.yaml_file import read_yaml

REGISTRATION = Path("config/registration.yaml")

Checksum = Annotated[str, Field(pattern="^[0-9a-f]{16}$")]


class Registered(Strict):
    """What is registered, as checksums."""

    claims: Checksum = Field(description="Of the claims with their measures and thresholds.")
    sweeps: Checksum = Field(
        description="Of the sweeps, with the reports and the rounds of the rule."
    )
    seeds: Checksum = Field(description="Of the seeds of every cell.")
    readings: Checksum = Field(description="Of the study's own readings.")
    beyond: Checksum | None = Field(
        default=None,
        description="Of what is expected beyond the thesis, and of the seeds of its cells; nothing "
        "before that was written down.",
    )


class Entry(Strict):
    """A version of what is judged, and what was known when it was written."""

    date: Annotated[str, Field(pattern=r"^\d{4}-\d{2}-\d{2}$")] = Field(
        description="When it was written."
    )
    registered: Registered = Field(description="What it is about.")
    unseen: Text = Field(description="Which seeds no run had used by then.")
    why: Text = Field(description="What changed against the entry before, and why.")


class Registration(Strict):
    """All entries."""

    entries: Annotated[tuple[Entry, ...], BeforeValidator(listed), Field(min_length=1)] = Field(
        description="Every version, the oldest first."
    )


def load_registration(path: Path) -> tuple[Entry, ...]:
    """The entries in a YAML file; ``BadInput`` with all its problems otherwise."""
    try:
        return Registration.model_validate(read_yaml(path)).entries
    except ValidationError as error:
        raise BadInput(explained(Registration, error, lambda *_: str(path))) from None


def of(
    study: Study,
    claims: Mapping[str, Claim],
    sweeps: Mapping[str, Sweep],
    beyond: tuple[Study, Mapping[str, Claim]] | None = None,
) -> Registered:
    """What an entry for these has to say; ``beyond`` is the study beyond the thesis with its claims."""
    asked = {name: one.model_dump(mode="json") for name, one in sweeps.items()}
    return Registered(
        claims=checksum_of(canonical_claims(claims)),
        sweeps=checksum_of(json.dumps(asked)),
        seeds=seeds_of(study),
        readings=checksum_of(study.readings.model_dump_json()),
        beyond=of_chapter(beyond[0], canonical_claims(beyond[1])) if beyond else None,
    )


def of_chapter(study: Study, claims: str) -> str:
    """The checksum of the study beyond the thesis: of its seeds and its claims, in canonical form."""
    return checksum_of(f"{seeds_of(study)} {claims}")


def seeds_of(study: Study) -> str:
    """The checksum of the seeds of every cell."""
    return checksum_of(json.dumps({cell: spec.seeds for cell, spec in Matrix(study).cells.items()}))


def changed_since(entry: Entry, now: Registered) -> list[str]:
    """What is no longer as an entry registered it."""
    return [
        name
        for name in Registered.model_fields
        if getattr(entry.registered, name) != getattr(now, name)
    ]


def checksum_of(text: str) -> str:
    """16 hexadecimal digits that change with a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]
