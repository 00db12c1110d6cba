"""Look at what came out: verdicts, figures, recordings."""

from typing import Annotated, Any

import typer

from upswing.cli.options import (
    AskedStudy,
    Claims,
    Named,
    Positional,
    Templates,
    asked_study,
    claims_of,
    results_folder,
)
from upswing.cli.panel import Job, Panel
from upswing.study.places import TEMPLATES

panel = Panel("Look")


@panel.subcommand("verdicts", cls=Job)
def verdicts(
    positional: Positional = None,
    results: Named = None,
    study: AskedStudy = "",
    claims: Claims = None,
    templates: Templates = TEMPLATES,
    details: Annotated[
        bool, typer.Option("--details", help="Also say what is measured, where, and how.")
    ] = False,
) -> None:
    """Judge every claim by the runs and print the verdicts; writes tables/verdicts.parquet."""
    from upswing.analysis.robustness.shipped import over_readings
    from upswing.analysis.verdicts import write_verdicts
    from upswing.cli.shown.verdicts import print_verdicts
    from upswing.runs.results import OwnRuns

    folder = results_folder(results, positional)
    found = OwnRuns(folder, asked_study(study))
    judged = claims_of(found.study, claims)
    over, _ = over_readings(folder, templates, judged)
    verdicts = write_verdicts(found, judged, over)
    print_verdicts(verdicts, details, found.study.judges, own=bool(found.study.claims))


def _figures() -> list[str]:
    from upswing.figures import NAMES

    return list(NAMES)


class _Figure(Job):
    """Its help lists the figures, which are imported for nothing else than help and drawing."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        self.epilog = f"The figures: {', '.join(_figures())}."
        super().format_help(ctx, formatter)


@panel.subcommand("figure", cls=_Figure)
def figure(
    name: Annotated[
        str,
        typer.Argument(
            metavar="FIGURE",
            help="5 to 11, as in the thesis, or a name from the list below.",
            autocompletion=_figures,
        ),
    ],
    positional: Positional = None,
    results: Named = None,
    study: AskedStudy = "",
    claims: Claims = None,
) -> None:
    """Draw a figure from the results, as SVG and PNG."""
    from upswing.figures import FIGURES, draw, named
    from upswing.runs.results import OwnRuns

    if name.isdigit():  # of the thesis, whatever the study has
        name = named(name)
    found = OwnRuns(results_folder(results, positional), asked_study(study))
    own = [one for one in found.study.figure_names if one not in list(FIGURES)]
    name = named(name, [*FIGURES, *own])
    judged = None
    if name in own or FIGURES[name].number:  # which shows what decides the claims that name it
        judged = claims_of(found.study, claims, checked=False)
    draw(name, found, judged)


@panel.subcommand(
    "browse",
    epilog="A FILTER is task=, architecture=, alpha=, seed= (0,3 or 0..4), claim=C13, or the id "
    "of a run, a cell or a task; several must all be fulfilled. All studies of the folder are opened "
    "together: its own, and those in folders right below it.",
)
def browse(
    filters: Annotated[
        list[str] | None, typer.Argument(metavar="FILTER", help="Which runs; all if none is given.")
    ] = None,
    results: Named = None,
    web: Annotated[
        bool, typer.Option("--web", help="Serve a page, where there is no display.")
    ] = False,
    only_say: Annotated[
        bool, typer.Option("--print", help="Only say what would be opened.")
    ] = False,
    port: Annotated[int, typer.Option(help="Of the catalog.")] = 9871,
    web_port: Annotated[int, typer.Option(help="Of the page.")] = 9872,
    report_port: Annotated[
        int, typer.Option(help="Of the report; a free one if this is in use.")
    ] = 9873,
) -> None:
    """Browse the recordings of all runs of all studies of a folder, or of some."""
    from upswing.cli.terminal import say
    from upswing.recordings.catalog import catalog_of, show
    from upswing.recordings.displays import check_display, has_display, tunnel
    from upswing.recordings.lending import lending
    from upswing.recordings.ports import check_free
    from upswing.recordings.studies import choose
    from upswing.study.paths import PAGE

    chosen, remarks = choose(results_folder(results), filters or ())
    if only_say:
        for one in chosen:
            print("\n".join(str(one.results.folder / path) for path in one.runs["recording"]))
        return
    if not web:  # before thousands of recordings are registered
        ways = tunnel([port, web_port, report_port])
        check_display(
            "`upswing browse --web` (or `make browse WEB=1`) serves a page instead. Over ssh, say on "
            f"the computer before you `{ways}` and open the address of the page there"
        )
    for number in (port, web_port) if web else (port,):
        check_free(number)
    for remark in remarks:
        say(remark)
    first = chosen[0].results
    with (
        catalog_of(chosen, port, lambda words: print(words, flush=True)) as served,
        lending(first, report_port) as lent,
    ):
        if (first.folder / PAGE).exists():
            print(f"the report, in which every run opens: {lent.page}", flush=True)
        if web and not has_display():
            ways = tunnel([port, web_port, lent.port])
            print(f"over ssh, first on the computer before you: {ways}", flush=True)
        show(served, web, web_port)
