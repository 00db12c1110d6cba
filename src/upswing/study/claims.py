"""The claims C1–C16 as data: what is measured, from where on a claim holds, and the verdict.

The claims themselves stand in ``config/claims.yaml``.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Self

from pydantic import (
    BeforeValidator,
    Field,
    RootModel,
    ValidationError,
    model_validator,
)

from upswing.study.claim_parts import Part
from upswing.study.config import Study
from upswing.study.errors import BadInput, explained
from upswing.study.known_cells import check_cells
from upswing.study.names import CellName, ClaimName, Text
from upswing.study.values import Strict, listed
from upswing.study.yaml_file import read_yaml

if TYPE_CHECKING:  # the workflow reads claims, and need not wait for scipy
    pass


class Claim(Strict):
    """A claim of the thesis."""

    statement: Text
    section: Text
    figure: Annotated[int, Field(ge=5, le=11)] | None = None  # of the thesis
    check: Text = ""  # why it is no evidence, but true by construction or proved
    cell: CellName | None = None  # the cell whose worst, median and best run show it
    note: Text = ""  # what a reader of the verdict must know
    parts: Annotated[tuple[Part, ...], BeforeValidator(listed), Field(min_length=1)]

    @model_validator(mode="after")
    def _is_always_asked(self) -> Self:
        if all(part.only_if for part in self.parts):
            raise ValueError("one of the parts must stand without `only_if`, or nothing is asked")
        return self


Claimed = Annotated[dict[ClaimName, Claim], Field(min_length=1)]


class Claims(RootModel[Claimed]):
    """All claims by their ids."""


def load_claims(path: Path, study: Study | None = None) -> Mapping[str, Claim]:
    """The claims written in a YAML file.

    Raises:
        BadInput: all that is wrong with them; with a ``study``, also cells that neither it nor another
            configuration beside the file has.
    """
    content: dict[str, Any] = read_yaml(path)
    try:
        claims = Claims.model_validate(content).root
    except ValidationError as error:
        raise BadInput(explained(Claims, error, lambda *_: str(path))) from None
    if study is not None:
        check_cells(dict(cells_of_claims(claims)), study, path)
    return claims


def cells_of_claims(claims: Mapping[str, Claim]) -> Iterator[tuple[str, str]]:
    """Every cell that is named, by where it stands."""
    for name, claim in claims.items():
        if claim.cell is not None:
            yield f"{name}.cell", claim.cell
        for number, part in enumerate(claim.parts):
            for key in ("cells", "each"):
                for at, cell in enumerate(getattr(part, key)):
                    yield f"{name}.parts[{number}].{key}[{at}]", cell
            for at, pair in enumerate(part.each_pair):
                for of, cell in enumerate(pair):
                    yield f"{name}.parts[{number}].each_pair[{at}][{of}]", cell


def canonical_claims(claims: Mapping[str, Claim]) -> str:
    """The claims as one line: the same text for the same meaning."""
    return Claims(dict(claims)).model_dump_json()
