"""What several subcommands are given: the folder of results, and files beside it."""

from pathlib import Path
from typing import Annotated

import typer

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

Claims = Annotated[Path, typer.Option(metavar="FILE", help="The file of claims.")]
Sweeps = Annotated[Path, typer.Option(metavar="FILE", help="The file of sweeps.")]
Templates = Annotated[Path, typer.Option(metavar="FOLDER", help="The templates of the page.")]
StudyText = Annotated[str, typer.Argument(metavar="STUDY", help="The study in JSON.")]

CLAIMS = Path("config/claims.yaml")
SWEEPS = Path("config/readings.yaml")
TEMPLATES = Path("report")


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
