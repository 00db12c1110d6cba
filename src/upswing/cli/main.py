"""The command ``upswing``: its groups of subcommands, and the exit code of each."""

import os
import sys
from collections.abc import Sequence
from io import TextIOWrapper
from typing import Annotated

import typer

from upswing import __version__
from upswing.cli.commands import adopt, compare, look, maintain, run, watch, workflow
from upswing.cli.failure import said_of
from upswing.cli.panel import Subcommands

PANELS = (
    run.panel,
    adopt.panel,
    look.panel,
    watch.panel,
    compare.panel,
    maintain.panel,
    workflow.panel,
)
"""The groups of subcommands, in the order of the help."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a subcommand; 0 if it went well, 2 for bad input, 1 for another failure or a change."""
    for stream in (sys.stdout, sys.stderr):  # α and φ stand in what is said, whatever the locale
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(encoding="utf-8")
    # Jobs run side by side; each computes in one thread.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    given = list(sys.argv[1:] if arguments is None else arguments)
    command = typer.main.get_command(_application())
    try:
        code: int | None = command.main(
            args=given, prog_name="upswing", obj=given, standalone_mode=False
        )
        sys.stdout.flush()
    except BrokenPipeError:  # `upswing verdicts | head`: nobody reads on, and nothing is to be said
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except Exception as error:
        failure = said_of(error)
        if failure is None:
            raise
        print(f"upswing: {failure.words}", file=sys.stderr)
        return failure.code
    return code or 0


def _application() -> typer.Typer:
    """All subcommands. Their help is in boxes in a terminal, and plain in a pipe or a file."""
    application = typer.Typer(
        cls=Subcommands,
        callback=_options,
        help="Reproduce the thesis Reinforcement Learning in Motor Control.",
        epilog="`make help` lists what runs the whole study.",
        subcommand_metavar="SUBCOMMAND",
        rich_markup_mode="rich" if sys.stdout.isatty() else None,
        pretty_exceptions_enable=False,
    )
    for panel in PANELS:
        application.add_typer(panel)
    return application


def _say_version(asked: bool) -> None:
    if asked:
        print(f"upswing {__version__}")
        raise typer.Exit


def _options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_say_version, is_eager=True, help="Say the version."),
    ] = False,
) -> None:
    """What may be given without a subcommand."""
