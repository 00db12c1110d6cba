"""The history of a study: what was found before, by which code and configuration."""

from pathlib import Path
from typing import Annotated

import typer

from upswing.cli.options import Named, Positional, results_folder
from upswing.cli.panel import Job, Subcommands

group = typer.Typer(
    cls=Subcommands,
    subcommand_metavar="[SUBCOMMAND]",
    help="Say what was found before: every study that came out otherwise has left an entry.",
    epilog="ID is @last (the newest), @1 (the number in the list; the oldest has the smallest), an "
    "entry's id or the beginning of it, or a git commit.",
)

Called = Annotated[
    str, typer.Argument(metavar="ID", help="@1, @last, an id or its beginning, or a git commit.")
]


@group.callback(invoke_without_command=True)
def history(context: typer.Context, results: Named = None) -> None:
    """Say what was found before: every study that came out otherwise has left an entry.

    Without a subcommand it lists the entries, the newest first.
    """
    context.meta["results"] = results
    if context.invoked_subcommand is not None:
        return
    from upswing.analysis.history.read import damaged, entries
    from upswing.cli.shown.history import print_entries

    folder = results_folder(results)
    print_entries(entries(folder), damaged(folder), folder)


def _folder(context: typer.Context, results: Path | None) -> Path:
    """The folder of results, which may be named before or after the subcommand."""
    return results_folder(results or context.meta.get("results"))


@group.command("show")
def show(context: typer.Context, called: Called = "@last", results: Named = None) -> None:
    """Say all that an entry holds: configuration, verdicts, versions, times."""
    from upswing.analysis.history.read import find
    from upswing.analysis.history.sides import of_entry
    from upswing.cli.shown.history import print_entry

    folder = _folder(context, results)
    entry = find(folder, called)
    print_entry(entry, of_entry(folder, entry.id), folder)


@group.command("note")
def note(
    context: typer.Context,
    called: Called,
    text: Annotated[str, typer.Argument(help="What is to be remembered, in one line.")],
    results: Named = None,
) -> None:
    """Add a note to an entry. The entry itself stays as it is."""
    from upswing.analysis.history.change import add_note
    from upswing.analysis.history.read import find
    from upswing.study.errors import BadInput
    from upswing.study.history_paths import checked_note

    folder = _folder(context, results)
    entry = find(folder, called)
    if not (checked := checked_note(text, "TEXT")):
        raise BadInput(["TEXT: must say something"])
    add_note(folder, entry.id, checked)
    print(f"added to {entry.name}")


@group.command("export")
def export(
    context: typer.Context,
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="What is written: ….parquet or ….csv.")
    ],
    results: Named = None,
) -> None:
    """Write one table of all entries: a row for each number of a cell and for each verdict."""
    from upswing.analysis.history.export import write_export

    rows, entries = write_export(_folder(context, results), file)
    print(f"{file}: {rows:,} rows of {entries} {'entry' if entries == 1 else 'entries'}")


@group.command("delete")
def delete(
    context: typer.Context,
    called: Called,
    yes: Annotated[bool, typer.Option("--yes", help="Delete it; without, only say which.")] = False,
    results: Named = None,
) -> int:
    """Delete an entry for good. The others keep their numbers."""
    from upswing.analysis.history.change import delete
    from upswing.analysis.history.read import find
    from upswing.study.history_paths import HISTORY

    folder = _folder(context, results)
    # One that is damaged is found by its folder only.
    by_folder = "/" not in called and called[:1].isdigit() and (folder / HISTORY / called).is_dir()
    identity = called if by_folder else find(folder, called).id
    if not yes:
        print(f"would delete {folder / HISTORY / identity}; nothing is deleted without --yes")
        return 2
    delete(folder, identity)
    print(f"deleted {folder / HISTORY / identity}")
    return 0


@group.command("write", cls=Job)
def write(context: typer.Context, positional: Positional = None, results: Named = None) -> None:
    """Write an entry, if the study came out otherwise than the last one (called by the workflow)."""
    import os

    from upswing.analysis.history.write import write_entry
    from upswing.study.history_paths import NOTE, checked_note

    folder = results_folder(results or context.meta.get("results"), positional)
    found = write_entry(folder, checked_note(os.environ.get(NOTE, ""), "NOTE"))
    if found.new:
        print(f"wrote {found.entry.name}")
    else:
        print(f"nothing came out otherwise than in {found.entry.name}: no entry was written")


@group.command("noted")
def noted(context: typer.Context, positional: Positional = None, results: Named = None) -> None:
    """Say whether the note that was given to a study has been kept (called by make)."""
    import os

    from upswing.analysis.history.read import entries
    from upswing.cli.shown.history import print_noted
    from upswing.study.history_paths import NOTE, checked_note

    folder = results_folder(results or context.meta.get("results"), positional)
    if note := checked_note(os.environ.get(NOTE, ""), "NOTE"):
        every = entries(folder)
        print_noted(every[-1] if every else None, note, folder)
