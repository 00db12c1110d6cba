"""Before a study runs. It is run by ``make reproduce`` and ``make study``."""

from pathlib import Path
from typing import Annotated

import typer

from upswing.cli.options import CLAIMS, SWEEPS, Claims, Sweeps
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
    claims: Claims = CLAIMS,
    sweeps: Sweeps = SWEEPS,
) -> None:
    """Check a configuration and say what it comes to."""
    from upswing.cli.shown.study import print_matrix
    from upswing.study.check import checked
    from upswing.study.matrix import Matrix

    print_matrix(Matrix(checked(config, claims, sweeps)))
