"""Before a study runs. It is run by ``make reproduce`` and ``make study``."""

import os
from pathlib import Path
from typing import Annotated

import typer

from upswing.cli.options import SWEEPS, Claims, Sweeps
from upswing.cli.panel import Panel

panel = Panel("Run")


def _configurations() -> list[str]:
    """The configurations of studies in ``config``, for the completion of their names."""
    there = (path for path in sorted(Path("config").glob("*.yaml")) if path.is_file())
    return [str(path) for path in there if b"\nexperiments:" in path.read_bytes()]


@panel.subcommand("check")
def check(
    config: Annotated[
        Path,
        typer.Argument(help="The configuration.", autocompletion=_configurations),
    ] = Path("config/config.yaml"),
    claims: Claims = None,
    sweeps: Sweeps = SWEEPS,
    begin: Annotated[
        bool,
        typer.Option(
            "--begin", help="As make does before a study: what is to come, and print its folder."
        ),
    ] = False,
) -> None:
    """Check a configuration and say what it comes to.

    And what its folder holds of that, and about how long and how large the rest will be.
    """
    from upswing.cli.shown.study import print_matrix, print_outlook
    from upswing.runs.outlook import outlook
    from upswing.study.check import checked
    from upswing.study.history_paths import NOTE, checked_note
    from upswing.study.matrix import Matrix

    matrix = Matrix(checked(config, claims, sweeps))
    if begin:
        checked_note(os.environ.get(NOTE, ""), "NOTE")
    else:
        print_matrix(matrix)
    results = matrix.study.results
    print_outlook(outlook(matrix, Path(results)), results, beginning=begin)
