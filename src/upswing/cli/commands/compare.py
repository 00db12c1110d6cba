"""Two folders of results: two commits, two machines, before and after an edit."""

from pathlib import Path
from typing import Annotated

import typer

from upswing.cli.options import Named, results_folder
from upswing.cli.panel import Panel

panel = Panel("Compare")


@panel.subcommand("compare")
def compare(
    a: Annotated[Path, typer.Argument(metavar="A", help="A folder of results.")],
    b: Annotated[
        Path | None,
        typer.Argument(metavar="B", help="Another; the same as --results.", show_default=False),
    ] = None,
    results: Named = None,
) -> int:
    """Compare two folders of results: verdicts, estimates and runs that differ.

    The exit code is 1 if a verdict did.
    """
    from upswing.analysis.compare import compare
    from upswing.cli.shown.folders import print_comparison

    comparison = compare(a, results_folder(results, b))
    print_comparison(comparison)
    return 1 if comparison.changed_verdicts else 0
