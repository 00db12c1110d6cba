"""Agents from elsewhere in the same study."""

import re
from pathlib import Path
from typing import Annotated

import typer

from upswing.cli.options import Named, results_folder
from upswing.cli.panel import Panel

panel = Panel("Run")


@panel.subcommand(
    "adopt",
    epilog="AGENT is file.py:function or module:function. The function takes an observation "
    "(cos φ, sin φ, φ̇ [rad/s]) and answers 0, 1 or 2; or it takes `seed`, or nothing, and answers "
    "with such a function. Its file is run: adopt only what you would run yourself. "
    "docs/adopt.md shows it with stable-baselines3.",
)
def adopt(
    agent: Annotated[str, typer.Argument(help="The agent: ppo.py:policy, for example.")],
    task: Annotated[str, typer.Option(help="The task, by its name in the study.")],
    name: Annotated[
        str, typer.Option(help="What it is called in tables (default: the name of its file).")
    ] = "",
    seed: Annotated[
        list[int] | None,
        typer.Option(
            min=0, help="Of a run; may be given several times (default: the study's first)."
        ),
    ] = None,
    reads: Annotated[
        list[Path] | None,
        typer.Option(
            "--reads",
            metavar="FILE",
            help="A file that the agent reads, its weights for example: its checksum is kept.",
        ),
    ] = None,
    results: Named = None,
) -> None:
    """Let an agent from elsewhere act in a task, and keep its runs beside those of the study."""
    from upswing.analysis.aggregate import write_tables
    from upswing.runs.adopt import Asked, adopt
    from upswing.runs.adopted import file_of_cell, joined
    from upswing.runs.study_file import read_study
    from upswing.study.paths import RUNS

    folder = results_folder(results)
    seeds = tuple(seed) if seed else read_study(folder).seeds[:1]
    called = name or _name_of(agent)
    spec = adopt(folder, Asked(agent, task, called, seeds, reads or ()))
    print(f"{spec.cell} is part of {folder} as long as {file_of_cell(folder, spec)} is there")
    if (folder / RUNS).is_file():
        write_tables(folder, joined(folder))
        print("and stands in its tables; make the study again for its figures and its page")
    else:
        print("and will stand in its tables, figures and page when the study is finished")


def _name_of(agent: str) -> str:
    """A name for an agent that was given none: that of its file or module."""
    place = agent.rpartition(":")[0]
    last = Path(place).stem if place.endswith(".py") else place.rpartition(".")[2]
    return re.sub(r"[^a-z0-9]+", "-", last.lower()).strip("-")
