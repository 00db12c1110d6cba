"""What a failed subcommand says, and its exit code."""

from typing import NamedTuple

import typer


class Failure(NamedTuple):
    """The end of a subcommand that could not do what it was asked for."""

    words: str
    code: int  # 2 for bad input, 1 for anything else


def said_of(error: Exception) -> Failure | None:
    """What to say of ``error``; None if it is a mistake of ours, whose traceback is wanted."""
    if isinstance(error, typer.TyperException):
        return Failure(_of_the_command_line(error), error.exit_code)
    from upswing.study.errors import BadInput  # what is imported for it has its cost: only now

    if isinstance(error, BadInput):
        return Failure(str(error), 2)
    if isinstance(error, MemoryError):
        return Failure(f"not enough memory: {error}", 1)
    if isinstance(error, OSError | RuntimeError):
        return Failure(str(error), 1)
    if type(error).__module__.startswith("pyarrow"):
        first = str(error).splitlines()[0]
        return Failure(f"a table cannot be read: {first} (`upswing doctor` says which)", 1)
    return None


def _of_the_command_line(mistake: typer.TyperException) -> str:
    """A mistake in the command itself, in one line that ends with where its help is."""
    said = " ".join(mistake.format_message().split()).rstrip(".")
    context = getattr(mistake, "ctx", None)
    where = context.command_path if context else "upswing"
    return f"{said[:1].lower()}{said[1:]} (see `{where} --help`)"
