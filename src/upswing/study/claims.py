"""Claims as data: what is measured, from where on a claim holds, and the verdict.

Those of the thesis, C1–C16, stand in ``config/claims.yaml``; a study may name a file of its own.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import (
    BeforeValidator,
    Field,
    RootModel,
    TypeAdapter,
    ValidationError,
    model_validator,
)

from upswing.study.claim_parts import Part
from upswing.study.config import Study
from upswing.study.errors import BadInput, explained, near, problem
from upswing.study.known_cells import check_cells
from upswing.study.names import CellName, ClaimName, Name, Text
from upswing.study.physical import PendulumOptions, TileOptions
from upswing.study.places import CLAIMS
from upswing.study.project_files import along
from upswing.study.values import Strict, listed
from upswing.study.yaml_file import read_yaml


def _shown_in(figure: Any) -> Any:
    if isinstance(figure, bool) or not isinstance(figure, int | str | None):
        raise ValueError(
            "must be a figure of the thesis, 5 to 11, or the name of one of the study's"
        )
    if isinstance(figure, int) and not FIRST_FIGURE <= figure <= LAST_FIGURE:
        raise ValueError(f"the thesis's figures of runs are {FIRST_FIGURE} to {LAST_FIGURE}")
    return NAMED.validate_python(figure) if isinstance(figure, str) else figure


NAMED = TypeAdapter[str](Name)


FIRST_FIGURE, LAST_FIGURE = 5, 11


class Claim(Strict):
    """A claim: of the thesis, or of one's own."""

    statement: Text = Field(min_length=1, description="What is said, in a sentence.")
    section: Text = Field(
        default="", description="Where it is said: a section of the thesis; nothing of one's own."
    )
    figure: Annotated[int | str | None, BeforeValidator(_shown_in)] = Field(
        default=None,
        description="The figure that shows what decides it: 5 to 11 of the thesis, or the name of one "
        "of the study's own; none, where the key is left out.",
    )
    check: Text = Field(
        default="",
        description="Why it is no evidence, because it is true by construction or proved; only then.",
    )
    cell: CellName | None = Field(
        default=None,
        description="The cell whose worst, median and best run are shown side by side; none, where the "
        "key is left out.",
    )
    note: Text = Field(default="", description="What a reader of the verdict must know.")
    parts: Annotated[tuple[Part, ...], BeforeValidator(listed)] = Field(
        min_length=1,
        description="What is compared with which thresholds; it is as good as its weakest part.",
    )

    @model_validator(mode="after")
    def _is_always_asked(self) -> Self:
        if all(part.only_if for part in self.parts):
            raise ValueError("one of the parts must stand without `only_if`, or nothing is asked")
        return self


Claimed = Annotated[dict[ClaimName, Claim], Field(min_length=1)]


class Claims(RootModel[Claimed]):
    """All claims by their ids."""


def file_of_claims(study: Study, given: Path | None = None, otherwise: Path | None = None) -> Path:
    """Where the claims of a study stand.

    Args:
        study: it may name a file of its own.
        given: a file that is to be taken whatever the study names.
        otherwise: the file where there is neither; without it, the thesis's.
    """
    own = Path(study.claims) if study.claims else None
    return given or own or otherwise or along(CLAIMS)


def load_claims(path: Path, study: Study | None = None) -> Mapping[str, Claim]:
    """The claims written in a YAML file.

    Raises:
        BadInput: all that is wrong with them; with a ``study``, also cells that neither it nor another
            configuration beside the file has, and figures that it does not have.
    """
    content: dict[str, Any] = read_yaml(path)
    try:
        claims = Claims.model_validate(content).root
    except ValidationError as error:
        raise BadInput(explained(Claims, error, lambda *_: str(path))) from None
    if study is not None:
        check_cells(dict(cells_of_claims(claims)), study, path)
        if wrong := [
            *_unknown_figures(claims, study, path),
            *_not_represented(claims, study, path),
        ]:
            raise BadInput(wrong)
    return claims


def _unknown_figures(claims: Mapping[str, Claim], study: Study, path: Path) -> Iterator[str]:
    """Claims that name a figure which the study does not have."""
    for name, claim in claims.items():
        if isinstance(claim.figure, str) and claim.figure not in study.figure_names:
            there = study.figure_names or ("none",)
            right = f"no figure of this study; {near(claim.figure, there)}"
            yield problem(str(path), f"{name}.figure", claim.figure, right)


def _not_represented(claims: Mapping[str, Claim], study: Study, path: Path) -> Iterator[str]:
    """Claims about what a table can represent where the search for that is about another system."""
    for name, claim in claims.items():
        asks = any(part.kind == "share_represented" for part in claim.parts)
        task = study.tasks.get(claim.cell.partition("/")[0]) if asks and claim.cell else None
        if task is not None and (task.pendulum, task.tiles) != (PendulumOptions(), TileOptions()):
            right = (
                "what a table can represent is searched for the thesis's pendulum and tiles alone"
            )
            yield problem(str(path), f"{name}.cell", claim.cell, right)


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
