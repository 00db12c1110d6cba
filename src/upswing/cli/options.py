"""What several subcommands are given: the folder of results, and files beside it."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Mapping

    from upswing.study.claims import Claim
    from upswing.study.config import Study

RESULTS = Path("results")
"""The folder of results where none is given."""

Named = Annotated[
    Path | None,
    typer.Option(
        "--results",
        metavar="FOLDER",
        help=f"The folder of results (default: {RESULTS}).",
        show_default=False,
    ),
]
"""The folder as the option that every subcommand with results has."""

Positional = Annotated[
    Path | None,
    typer.Argument(metavar="RESULTS", help="The same as --results.", show_default=False),
]
"""The folder as the last argument, which the rules of the workflow give."""


def or_along(context: typer.Context, param: typer.CallbackParam, path: Path) -> Path:
    """What was given, or else what the working folder has, or else what comes with the package."""
    from upswing.study.project_files import along  # what is imported for it has its cost: only now

    source = context.get_parameter_source(str(param.name))
    return along(path) if source is not None and source.name == "DEFAULT" else path


def needs_checkout(what: str, *places: Path) -> None:
    """Refuse what renews files of the project where these are the installed package's or not there.

    Args:
        what: what is asked for, as it is called.
        places: the files or folders that would be renewed.

    Raises:
        BadInput: one of them is not in a checkout.
    """
    from upswing.study.errors import BadInput
    from upswing.study.project_files import is_own

    if any(is_own(place) or not place.exists() for place in places):
        raise BadInput([f"{what}: needs a checkout of the project, whose files it renews"])


Claims = Annotated[
    Path | None,
    typer.Option(
        metavar="FILE",
        help="The file of claims (default: the study's own, or config/claims.yaml).",
        show_default=False,
    ),
]
Sweeps = Annotated[
    Path, typer.Option(metavar="FILE", help="The file of sweeps.", callback=or_along)
]
Templates = Annotated[
    Path, typer.Option(metavar="FOLDER", help="The templates of the page.", callback=or_along)
]
StudyText = Annotated[str, typer.Argument(metavar="STUDY", help="The study in JSON.")]

AskedStudy = Annotated[
    str,
    typer.Option(
        "--study", metavar="JSON", help="The study; without it, the one the folder is of."
    ),
]
"""The study as the workflow asks for it, so that a job depends on no more of it than it needs."""


def asked_study(text: str) -> "Study | None":
    """The study that was asked for; None for the one that the folder is of."""
    from upswing.runs.study_file import parse_study

    return parse_study(text, "study") if text else None


def claims_of(study: "Study", given: Path | None, checked: bool = True) -> "Mapping[str, Claim]":
    """The claims that a study is judged by: those in the file that is given, its own, or the thesis's.

    Args:
        study: the study.
        given: the file that was given, if any.
        checked: whether cells and figures that they name must be there; a job of the workflow, which
            has checked them, need not look again.

    Raises:
        BadInput: all that is wrong with them.
    """
    from upswing.study.claims import file_of_claims, load_claims

    return load_claims(file_of_claims(study, given), study if checked else None)


def results_folder(named: Path | None, positional: Path | None = None) -> Path:
    """The folder of results that was asked for, however it was given.

    Raises:
        BadParameter: it was given in both ways, and they differ.
    """
    if named and positional and named.resolve() != positional.resolve():
        raise typer.BadParameter(
            f"{named}, while the argument says {positional}", param_hint="'--results'"
        )
    return named or positional or RESULTS
