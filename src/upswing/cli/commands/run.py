"""Before a study runs. It is run by ``make reproduce``, ``make study`` and Snakemake."""

import os
import shlex
from pathlib import Path
from typing import Annotated

import typer

from upswing.cli.options import Claims, Sweeps, or_along
from upswing.cli.panel import Panel
from upswing.study.places import CONFIG, SWEEPS

panel = Panel("Run")


def _configurations() -> list[str]:
    """The configurations of studies in ``config``, for the completion of their names."""
    there = (path for path in sorted(Path("config").glob("*.yaml")) if path.is_file())
    return [str(path) for path in there if b"\nexperiments:" in path.read_bytes()]


@panel.subcommand("init")
def init(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="A new folder, or an empty one.")
    ],
    templates: Annotated[
        bool,
        typer.Option("--templates", help="Copy the page's templates too, to be changed."),
    ] = False,
) -> None:
    """Write a folder for studies of your own, which needs no checkout."""
    from upswing.study.new_folder import write_folder

    held = write_folder(folder, templates)
    print(f"{folder}: {', '.join(held)}")
    print(f"cd {shlex.quote(str(folder))}")
    print("snakemake --cores all --configfile config/smoke.yaml  # a short study")
    print("snakemake --cores all  # the study of the thesis")


@panel.subcommand("check")
def check(
    config: Annotated[
        Path,
        typer.Argument(
            help="The configuration.", autocompletion=_configurations, callback=or_along
        ),
    ] = CONFIG,
    claims: Claims = None,
    sweeps: Sweeps = SWEEPS,
    begin: Annotated[
        bool,
        typer.Option(
            "--begin", help="As make does before a study: what is to come, and print its folder."
        ),
    ] = False,
    folder: Annotated[
        bool, typer.Option("--folder", help="Only print the folder of its results.")
    ] = False,
    results: Annotated[
        str,
        typer.Option(
            metavar="FOLDER",
            help="Another folder of results than the configuration says.",
            show_default=False,
        ),
    ] = "",
) -> None:
    """Check a configuration and say what it comes to.

    And what its folder holds of that, and about how long and how large the rest will be.
    """
    from upswing.cli.shown.study import print_matrix, print_outlook
    from upswing.runs.outlook import outlook
    from upswing.study.check import checked
    from upswing.study.history_paths import NOTE, checked_note
    from upswing.study.matrix import Matrix

    study = checked(config, claims, sweeps, {"results": results} if results else None)
    if folder:
        print(study.results)
        return
    matrix = Matrix(study)
    if begin:
        checked_note(os.environ.get(NOTE, ""), "NOTE")
    else:
        print_matrix(matrix)
    print_outlook(outlook(matrix, Path(study.results)), study.results, beginning=begin)
