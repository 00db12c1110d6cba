"""Look at a run while it happens: learning, or following what it learned."""

import os
from pathlib import Path
from typing import Annotated

import typer

from upswing.cli.options import Named, results_folder
from upswing.cli.panel import Panel
from upswing.study.places import CONFIG

panel = Panel("Look")

Web = Annotated[bool, typer.Option("--web", help="Serve a page, where there is no display.")]
Port = Annotated[int, typer.Option(help="Of the page's stream.")]
WebPort = Annotated[int, typer.Option(help="Of the page.")]
PORT, WEB_PORT = 9874, 9875


@panel.subcommand(
    "watch",
    epilog="A RUN is an id, of the study or not: full-control/table/alpha-0.01/seed-3. Or say what "
    "it is made of: --task full-control --architecture table --alpha 0.01. Nothing is stored.",
)
def watch(
    run: Annotated[
        str,
        typer.Argument(
            metavar="[RUN]", help="An id, or a specification in JSON.", show_default=False
        ),
    ] = "",
    task: Annotated[str | None, typer.Option(metavar="NAME", help="A task of the study.")] = None,
    architecture: Annotated[
        str | None, typer.Option(metavar="NAME", help="An architecture of the study.")
    ] = None,
    alpha: Annotated[float | None, typer.Option(metavar="α", help="The step size.")] = None,
    seed: Annotated[int | None, typer.Option(metavar="N", help="The seed (default: 0).")] = None,
    steps: Annotated[int | None, typer.Option(metavar="N", help="Another number of steps.")] = None,
    speed: Annotated[
        str, typer.Option(metavar="SPEED", help="real, fast, or so many times real time: 10.")
    ] = "real",
    web: Web = False,
    save: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write what would be shown, and show nothing."),
    ] = None,
    results: Named = None,
    config: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help=f"The study that has the names (default: that of the results, or {CONFIG}).",
            show_default=False,
        ),
    ] = None,
    port: Port = PORT,
    web_port: WebPort = WEB_PORT,
) -> None:
    """Watch a run learn, in the viewer: bit for bit the run of the study."""
    from upswing.recordings.watched import watched_run
    from upswing.study.asked_run import Asked
    from upswing.study.project_files import along

    _quiet()
    folder = results_folder(results)
    asked = Asked(task, architecture, alpha, seed, steps)
    spec = watched_run(folder, config, along(CONFIG), run, asked)
    from upswing.recordings.looking import page, window
    from upswing.recordings.pace import parse_speed
    from upswing.recordings.watch import watch_in, watch_into

    pace = parse_speed(speed)
    if save is not None:
        watch_into(save, spec, pace, folder)
    else:
        watch_in(page(port, web_port) if web else window(), spec, pace, folder)


@panel.subcommand(
    "play",
    epilog="WHAT is a run of the study, or a file *.weights.safetensors. A GIF plays in real time.",
)
def play(
    what: Annotated[str, typer.Argument(metavar="WHAT", help="A run, or a file of weights.")],
    angle: Annotated[
        float | None,
        typer.Option(
            "--from",
            metavar="DEGREES",
            help="Where it starts; 0 is upright (default: 180, hanging; balancing: -20).",
            show_default=False,
        ),
    ] = None,
    velocity: Annotated[
        float, typer.Option(metavar="RAD/S", help="The angular velocity at the start.")
    ] = 0.0,
    push: Annotated[
        float, typer.Option(metavar="RAD/S", help="Push it: change its angular velocity by this.")
    ] = 0.0,
    at: Annotated[float, typer.Option(metavar="SECOND", help="When it is pushed.")] = 5.0,
    seconds: Annotated[float, typer.Option(metavar="S", help="How long it is followed.")] = 20.0,
    to: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Write a .gif, .png or .rrd, and show nothing."),
    ] = None,
    web: Web = False,
    results: Named = None,
    port: Port = PORT,
    web_port: WebPort = WEB_PORT,
) -> None:
    """Follow what a run learned from a start of your choice, with a push."""
    _quiet()
    from upswing.recordings.looking import page, window
    from upswing.recordings.play import (
        Start,
        check_name,
        first_start,
        follow,
        learned_of,
        play_in,
        play_into,
    )

    if to is not None:
        check_name(to)
    learned = learned_of(what, results_folder(results))
    angle = first_start(learned) if angle is None else angle
    played = follow(learned, Start(angle, velocity, push, at, seconds))
    if to is not None:
        play_into(to, played)
    else:
        play_in(page(port, web_port) if web else window(), played)


def _quiet() -> None:
    """Have the viewer report failures only, and not that whoever closed it broke the stream.

    It is read when Rerun is imported.
    """
    os.environ.setdefault("RUST_LOG", "error,re_sdk=off,re_grpc_client=off,winit=error")
