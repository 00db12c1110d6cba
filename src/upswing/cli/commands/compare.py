"""Studies held against each other: edits, commits, machines; and what was found before."""

from pathlib import Path
from typing import Annotated

import typer

from upswing.cli.commands import history
from upswing.cli.options import Named, results_folder
from upswing.cli.panel import Panel

panel = Panel("Compare")
panel.add_typer(history.group, name="history", rich_help_panel=panel.title)


@panel.subcommand(
    "compare",
    epilog="A STUDY is a folder of results, or an entry of a history as `upswing history` calls it: "
    "@1, @last, an id or the beginning of it, or a git commit.",
)
def compare(
    studies: Annotated[
        list[str],
        typer.Argument(
            metavar="STUDY...", help="Two or more; one alone is compared with --results."
        ),
    ],
    results: Named = None,
    everything: Annotated[
        bool, typer.Option("--all", help="Name every cell that differs, and every run.")
    ] = False,
) -> int:
    """Compare studies: what was asked, and the cells, verdicts and runs that differ.

    --results is the folder whose history is meant. The exit code is 1 if a verdict differs.
    """
    from upswing.analysis.compare import compare
    from upswing.analysis.history.called import sides
    from upswing.cli.shown.compare import print_comparison

    folder = results_folder(results)
    called = studies if len(studies) > 1 else [*studies, str(folder)]
    if results and len(studies) > 1 and not any(_may_be_an_entry(one, folder) for one in studies):
        results_folder(results, Path(studies[-1]))
    found = sides(called, folder)
    comparison = compare(found)
    print_comparison(
        comparison, [side.label for side in found], [s.place for s in found], everything
    )
    return 1 if comparison.verdicts else 0


def _may_be_an_entry(called: str, results: Path) -> bool:
    """Whether an entry of the history of ``results`` may be meant, and not a folder."""
    from upswing.analysis.history.read import entries

    return called.startswith("@") or (not Path(called).is_dir() and bool(entries(results)))
