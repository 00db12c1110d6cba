"""What the rules of the workflow call, to make one file or several; by hand, to repeat a job."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from upswing.cli.options import (
    AskedStudy,
    Claims,
    Named,
    Positional,
    StudyText,
    Sweeps,
    Templates,
    asked_study,
    claims_of,
    results_folder,
)
from upswing.cli.panel import Job, Panel
from upswing.study.places import SWEEPS, TEMPLATES

if TYPE_CHECKING:
    from upswing.study.config import Study
    from upswing.study.spec import Spec
    from upswing.study.sweeps import Sweep

panel = Panel("Called by the workflow")


@panel.subcommand("study", cls=Job)
def study(text: StudyText, results: Named = None) -> None:
    """Keep a study's configuration beside its results."""
    from upswing.runs.study_file import write_study

    write_study(text, results_folder(results))


@panel.subcommand("train")
def train(
    texts: Annotated[
        list[str],
        typer.Argument(metavar="SPEC", help="A specification in JSON, as a run's log shows it."),
    ],
    results: Named = None,
) -> None:
    """Learn the runs of specifications and store them."""
    from upswing.study.spec import parse

    specs = [parse(text) for text in texts]  # all of them, before anything is written
    _refuse_adopted(specs)
    from upswing.runs.train import train

    for spec in specs:
        train(spec, results_folder(results))


def _refuse_adopted(specs: "list[Spec]") -> None:
    """What a specification names is no reason to run somebody's code."""
    from upswing.study.errors import BadInput

    adopted = [spec for spec in specs if spec.architecture.learner == "adopted"]
    if adopted:
        raise BadInput(
            [
                f"spec: {one.cell}: is of an adopted agent; `upswing adopt` runs it"
                for one in adopted
            ]
        )


@panel.subcommand("tables", cls=Job)
def tables(positional: Positional = None, results: Named = None) -> None:
    """Write tables/runs.parquet and tables/cells.parquet."""
    from upswing.analysis.aggregate import write_tables
    from upswing.runs.adopted import joined

    folder = results_folder(results, positional)
    write_tables(folder, joined(folder))


@panel.subcommand("comparison", cls=Job)
def comparison(
    name: Annotated[str, typer.Argument(help="task-… or claim-…: task-balancing, claim-C13.")],
    positional: Positional = None,
    results: Named = None,
    study: AskedStudy = "",
    claims: Claims = None,
) -> None:
    """Write a recording that compares runs: all of a task, or those that show a claim."""
    from upswing.recordings.comparison import write_comparison
    from upswing.runs.results import OwnRuns

    folder = results_folder(results, positional)
    found = OwnRuns(folder, asked_study(study))
    print(write_comparison(found, claims_of(found.study, claims, checked=False), name))


@panel.subcommand("comparisons", cls=Job)
def comparisons(
    positional: Positional = None, results: Named = None, claims: Claims = None
) -> None:
    """Write all recordings that compare runs."""
    from upswing.recordings.comparison import write_comparisons
    from upswing.runs.results import OwnRuns

    found = OwnRuns(results_folder(results, positional))
    for path in write_comparisons(found, claims_of(found.study, claims, checked=False)):
        print(path)


@panel.subcommand("viewer", cls=Job)
def viewer(
    positional: Positional = None,
    results: Named = None,
    study: AskedStudy = "",
    claims: Claims = None,
    templates: Templates = TEMPLATES,
) -> None:
    """Write report/viewer: the report's recordings, to open without a server."""
    from upswing.recordings.viewer import write_viewer
    from upswing.runs.results import OwnRuns

    folder = results_folder(results, positional)
    found = OwnRuns(folder, asked_study(study))
    for name in write_viewer(found, claims_of(found.study, claims, checked=False), templates):
        print(name)


@panel.subcommand("report", cls=Job)
def report(
    positional: Positional = None, results: Named = None, templates: Templates = TEMPLATES
) -> None:
    """Write report/index.html."""
    from upswing.report.page import write_report

    write_report(results_folder(results, positional), templates)


@panel.subcommand("bound", cls=Job)
def bound(positional: Positional = None, results: Named = None, study: AskedStudy = "") -> None:
    """Say by dynamic programming how good anything can be (tables/bound.parquet)."""
    from upswing.optimal.bound import write_bound

    folder = results_folder(results, positional)
    write_bound(folder, _asked_or_kept(study, folder))


@panel.subcommand("settling", cls=Job)
def settling(positional: Positional = None, results: Named = None, study: AskedStudy = "") -> None:
    """Watch value and policy iteration settle, sweep by sweep (tables/settling.parquet)."""
    from upswing.optimal.body import body_of_study
    from upswing.optimal.settling import write_settling

    folder = results_folder(results, positional)
    write_settling(folder, body_of_study(_asked_or_kept(study, folder)))


@panel.subcommand("prediction", cls=Job)
def prediction(
    positional: Positional = None, results: Named = None, study: AskedStudy = ""
) -> None:
    """Let TD and Monte Carlo predict what random actions are worth (tables/prediction.parquet)."""
    from upswing.optimal.body import body_of_study
    from upswing.optimal.prediction import write_prediction

    folder = results_folder(results, positional)
    write_prediction(folder, body_of_study(_asked_or_kept(study, folder)))


def _asked_or_kept(text: str, folder: Path) -> "Study | None":
    """The study that is given, or that of the folder; None where there is neither."""
    from upswing.runs.study_file import read_study
    from upswing.study.paths import STUDY

    return asked_study(text) or (read_study(folder) if (folder / STUDY).exists() else None)


@panel.subcommand("tiles", cls=Job)
def tiles(positional: Positional = None, results: Named = None) -> None:
    """Look for a policy on the thesis's tiles that does full control (tables/tiles.parquet)."""
    from upswing.optimal.represented import write_represented

    found = write_represented(results_folder(results, positional))
    print(f"{found['success'].sum()} of {len(found)} starts succeed")


@panel.subcommand("changes", cls=Job)
def changes(positional: Positional = None, results: Named = None) -> None:
    """Write tables/changes.parquet: what each change to the thesis buys."""
    from upswing.analysis.ablation import write_changes
    from upswing.cli.shown.beyond import print_changes

    print_changes(write_changes(results_folder(results, positional)))


@panel.subcommand("shortest", cls=Job)
def shortest(text: StudyText, results: Named = None) -> None:
    """Search for what succeeds every time, and how soon."""
    from upswing.analysis.search import write_shortest
    from upswing.cli.shown.beyond import print_chosen
    from upswing.runs.study_file import parse_study

    print_chosen(write_shortest(parse_study(text, "study"), results_folder(results)))


@panel.subcommand("sweep", cls=Job)
def sweep(
    name: Annotated[str, typer.Argument(metavar="SWEEP", help="Its name in the file of sweeps.")],
    group: Annotated[str, typer.Argument(help="The name of the group of readings.")],
    positional: Positional = None,
    results: Named = None,
    study: AskedStudy = "",
    sweeps: Sweeps = SWEEPS,
) -> None:
    """Run cells of the study under a group of other readings and keep the measures."""
    from upswing.runs.sweep import write_group
    from upswing.study import jobs

    folder = results_folder(results, positional)
    asked, found = _sweep_named(name, folder, study, sweeps)
    code = jobs.sweep(found, asked).fingerprint
    print(write_group(folder, asked, name, found, group, code))


@panel.subcommand("finalists", cls=Job)
def finalists(
    name: Annotated[str, typer.Argument(metavar="SWEEP", help="Its name in the file of sweeps.")],
    number: Annotated[int, typer.Argument(metavar="ROUND", min=2, help="The round, from 2.")],
    positional: Positional = None,
    results: Named = None,
    study: AskedStudy = "",
    sweeps: Sweeps = SWEEPS,
) -> None:
    """Say which readings of a sweep are likely enough to go on to a round with more seeds."""
    from upswing.analysis.robustness.selection import write_finalists
    from upswing.study.errors import BadInput

    folder = results_folder(results, positional)
    asked, found = _sweep_named(name, folder, study, sweeps)
    if number > (last := len(found.rounds) + 1):
        raise BadInput([f"{sweeps}: {name}: round {number}: there is none; the last is {last}"])
    print(write_finalists(folder, asked, name, found, number))


def _sweep_named(name: str, results: Path, study: str, sweeps: Path) -> "tuple[Study, Sweep]":
    """The study that is asked for, and a sweep of it; ``BadInput`` if there is none of this name."""
    from upswing.runs.study_file import read_study
    from upswing.study.errors import BadInput, near
    from upswing.study.sweeps import load_sweeps

    asked = asked_study(study) or read_study(results)
    known = load_sweeps(sweeps, asked)
    if name not in known:
        raise BadInput([f"{sweeps}: {name}: no such sweep; {near(name, known)}"])
    return asked, known[name]


@panel.subcommand("readings", cls=Job)
def readings(
    positional: Positional = None,
    results: Named = None,
    study: AskedStudy = "",
    sweeps: Sweeps = SWEEPS,
    claims: Claims = None,
) -> None:
    """Judge every claim under every reading of the sweeps, and choose the networks' default."""
    from upswing.analysis.robustness.write import write_readings
    from upswing.cli.shown.readings import print_robustness
    from upswing.figures.readings import draw_readings
    from upswing.runs.study_file import read_study
    from upswing.study.sweeps import load_sweeps

    folder = results_folder(results, positional)
    asked = asked_study(study) or read_study(folder)
    swept, judged = load_sweeps(sweeps, asked), claims_of(asked, claims)
    print_robustness(write_readings(folder, swept, judged, asked))
    draw_readings(folder, swept)
