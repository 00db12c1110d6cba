"""What subcommands are made of: panels of the help, and jobs whose log says how to repeat them."""

import shlex
from collections.abc import Callable
from typing import Any, TypeVar

import typer
from typer.core import TyperCommand, TyperGroup

F = TypeVar("F", bound=Callable[..., int | None])


class Job(TyperCommand):
    """A job of the workflow: what it says, which is its log, begins with how to repeat it."""

    def invoke(self, ctx: Any) -> Any:
        """Run the job; the context's object is what was given on the command line."""
        print("to repeat it:", shlex.join(["upswing", *ctx.obj]), flush=True)
        return super().invoke(ctx)


class Panel(typer.Typer):
    """A group of subcommands that stand together in the help of ``upswing``."""

    def __init__(self, title: str) -> None:
        super().__init__()
        self.title = title

    def subcommand(
        self, name: str, cls: type[TyperCommand] = TyperCommand, epilog: str | None = None
    ) -> Callable[[F], F]:
        """Make a function a subcommand of this panel; what it returns is the exit code (none: 0)."""
        return self.command(name, cls=cls, epilog=epilog, rich_help_panel=self.title)


class Subcommands(TyperGroup):
    """All subcommands. Typer draws their panels in a terminal; plain help has a heading for each."""

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the name and the purpose of each subcommand, below the heading of its panel."""
        rows: dict[str, list[tuple[str, str]]] = {}
        for name, command in self.commands.items():
            panel = getattr(command, "rich_help_panel", None) or "Subcommands"
            rows.setdefault(panel, []).append((name, (command.help or "").splitlines()[0]))
        longest = max(map(len, self.commands))
        for panel, of_panel in rows.items():
            with formatter.section(panel):
                formatter.write_dl([(name.ljust(longest), purpose) for name, purpose in of_panel])
