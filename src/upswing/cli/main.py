"""The subcommands: each calls one typed function, so that every job can be repeated by hand."""

import argparse
import json
import os
import shlex
import sys
from collections.abc import Sequence
from io import TextIOWrapper
from pathlib import Path

from upswing import __version__
from upswing.study.errors import BadInput


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a subcommand; 0 if it went well, 2 for bad input, 1 for another failure or a change."""
    for stream in (sys.stdout, sys.stderr):  # α and φ stand in what is said, whatever the locale
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(encoding="utf-8")
    options = _parser().parse_args(arguments)
    # Jobs run side by side; each computes in one thread.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    if options.repeatable:  # a job of the workflow: its log says how to repeat it
        given = sys.argv[1:] if arguments is None else arguments
        print("to repeat it:", shlex.join(["upswing", *given]), flush=True)
    try:
        code: int | None = options.call(options)
    except BadInput as error:
        print(f"upswing: {error}", file=sys.stderr)
        return 2
    except MemoryError as error:
        print(f"upswing: not enough memory: {error}", file=sys.stderr)
        return 1
    except (OSError, RuntimeError) as error:
        print(f"upswing: {error}", file=sys.stderr)
        return 1
    except Exception as error:
        if not type(error).__module__.startswith("pyarrow"):
            raise
        said = str(error).splitlines()[0]
        print(
            f"upswing: a table cannot be read: {said} (`upswing doctor` says which)",
            file=sys.stderr,
        )
        return 1
    return code or 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="upswing",
        description="Reproduce the thesis Reinforcement Learning in Motor Control.",
        epilog="`make help` lists what runs the whole study.",
    )
    parser.add_argument("--version", action="version", version=f"upswing {__version__}")
    parser.set_defaults(repeatable=False)
    subcommands = parser.add_subparsers(required=True, metavar="SUBCOMMAND")

    def add(name: str, function: object, summary: str) -> argparse.ArgumentParser:
        added = subcommands.add_parser(name, help=summary, description=summary)
        added.set_defaults(call=function)
        return added

    results = argparse.ArgumentParser(add_help=False)
    results.add_argument(
        "results", nargs="?", type=Path, default=Path("results"), help="folder (default: results)"
    )

    added = add("train", _train, "Learn the runs of specifications and store them.")
    added.add_argument("spec", nargs="+", help="a specification in JSON, as a run's log shows it")
    added.add_argument("--results", type=Path, default=Path("results"), help="folder to write to")

    added = subcommands.add_parser(
        "verdicts", help="Judge every claim and print the verdicts.", parents=[results],
        description="Judge every claim by the runs, write tables/verdicts.parquet and print it.",
    )  # fmt: skip
    added.add_argument("--claims", type=Path, default=Path("config/claims.yaml"))
    added.set_defaults(call=_verdicts, repeatable=True)

    summary = "Compare two folders of results: verdicts, estimates and runs that differ."
    added = subcommands.add_parser("compare", help=summary, description=summary)
    added.add_argument("a", type=Path)
    added.add_argument("b", type=Path)
    added.set_defaults(call=_compare)

    summary = "Browse the recordings of all runs, or of some."
    added = subcommands.add_parser(
        "browse", help=summary, description=summary,
        epilog="A FILTER is task=, architecture=, alpha=, seed= (0,3 or 0..4), claim=C13, or the id "
        "of a run, a cell or a task; several must all be fulfilled.",
    )  # fmt: skip
    added.add_argument("filter", nargs="*", metavar="FILTER")
    added.add_argument("--results", type=Path, default=Path("results"))
    added.add_argument("--web", action="store_true", help="serve a page, where there is no display")
    added.add_argument("--print", action="store_true", help="only say what would be opened")
    added.add_argument("--port", type=int, default=9871, help="of the catalog (default: 9871)")
    added.add_argument("--web-port", type=int, default=9872, help="of the page (default: 9872)")
    added.add_argument(
        "--report-port", type=int, default=9873,
        help="of the report (default: 9873, or a free one if that is in use)",
    )  # fmt: skip
    added.set_defaults(call=_browse)

    summary = "Take the README's pictures of the recordings, in a viewer without a screen."
    added = subcommands.add_parser(
        "screenshots", help=summary, description=summary, parents=[results]
    )
    added.add_argument("--into", type=Path, default=Path("report/pictures"))
    added.add_argument("--run", default="full-control/table/alpha-0.01/seed-4")
    added.add_argument("--task", default="full-control")
    added.set_defaults(call=_screenshots)

    summary = "Check that a folder of results is whole; says what to delete where it is not."
    added = subcommands.add_parser("doctor", help=summary, description=summary, parents=[results])
    added.set_defaults(call=_doctor)

    summary = "Delete the files of runs that are not, or no longer, in the study."
    added = subcommands.add_parser(
        "clean-orphans", help=summary, description=summary, parents=[results]
    )
    added.set_defaults(call=_clean_orphans)

    summary = "Renew what the README shows of the results."
    added = subcommands.add_parser("readme", help=summary, description=summary, parents=[results])
    added.add_argument("--templates", type=Path, default=Path("report"))
    added.add_argument("--readme", type=Path, default=Path("README.md"))
    added.set_defaults(call=_readme)

    of_results = (
        ("tables", _tables, "Write tables/runs.parquet and tables/cells.parquet."),
        ("comparisons", _comparisons, "Write the recordings that compare runs."),
        (
            "viewer",
            _viewer,
            "Write report/viewer: the report's recordings, to open without a server.",
        ),
        ("report", _report, "Write report/index.html."),
        (
            "bound",
            _bound,
            "Say by dynamic programming how good anything can be (tables/bound.parquet).",
        ),
        ("changes", _changes, "Write tables/changes.parquet: what each change to the thesis buys."),
    )
    for name, function, summary in of_results:
        added = subcommands.add_parser(name, help=summary, description=summary, parents=[results])
        added.set_defaults(call=function, repeatable=True)
        if name in ("viewer", "report"):
            added.add_argument(
                "--templates", type=Path, default=Path("report"), help="folder of the templates"
            )

    summary = "Draw a figure from the results, as SVG and PNG."
    added = subcommands.add_parser("figure", help=summary, description=summary)
    added.add_argument("figure", help="5 to 11, as in the thesis, or the name of one of ours")
    added.add_argument("results", nargs="?", type=Path, default=Path("results"))
    added.set_defaults(call=_figure, repeatable=True)

    summary = "Run cells of the study under a group of other readings and keep the measures."
    added = subcommands.add_parser("sweep", help=summary, description=summary)
    added.add_argument("sweep", help="its name in the file of sweeps")
    added.add_argument("group", help="the name of the group of readings")
    added.add_argument("results", nargs="?", type=Path, default=Path("results"))
    added.add_argument("--study", help="the study in JSON (default: the one the folder is of)")
    added.add_argument("--sweeps", type=Path, default=Path("config/readings.yaml"))
    added.set_defaults(call=_sweep, repeatable=True)

    summary = (
        "Judge every claim under every reading of the sweeps, and choose the networks' default."
    )
    added = subcommands.add_parser("readings", help=summary, description=summary, parents=[results])
    added.add_argument("--sweeps", type=Path, default=Path("config/readings.yaml"))
    added.add_argument("--claims", type=Path, default=Path("config/claims.yaml"))
    added.set_defaults(call=_readings, repeatable=True)

    added = add("study", _study, "Keep a study's configuration beside its results.")
    added.set_defaults(repeatable=True)
    added.add_argument("study", help="the study in JSON")
    added.add_argument("--results", type=Path, default=Path("results"), help="folder to write to")

    added = add("shortest", _shortest, "Search for what succeeds every time, and how soon.")
    added.set_defaults(repeatable=True)
    added.add_argument("study", help="the study in JSON")
    added.add_argument("--results", type=Path, default=Path("results"), help="folder to write to")

    added = add("check", _check, "Check a configuration and say what it comes to.")
    added.add_argument("config", nargs="?", type=Path, default=Path("config/config.yaml"))
    added.add_argument("--claims", type=Path, default=Path("config/claims.yaml"))
    added.add_argument("--sweeps", type=Path, default=Path("config/readings.yaml"))

    add("schema", _schema, "Print the JSON schema of a configuration.")
    add("keys", _keys, "Print what every key of a configuration means, in Markdown.")
    return parser


def _train(options: argparse.Namespace) -> None:
    from upswing.study.spec import parse

    specs = [parse(text) for text in options.spec]  # all of them, before anything is written
    from upswing.runs.train import train

    for spec in specs:
        train(spec, options.results)


def _tables(options: argparse.Namespace) -> None:
    from upswing.analysis.aggregate import write_tables
    from upswing.runs.study_file import read_study
    from upswing.study.matrix import Matrix

    write_tables(options.results, Matrix(read_study(options.results)))


def _verdicts(options: argparse.Namespace) -> None:
    from upswing.analysis.verdicts import write_verdicts
    from upswing.cli.terminal import print_verdicts
    from upswing.runs.study_file import read_study
    from upswing.study.claims import load_claims

    claims = load_claims(options.claims, read_study(options.results))
    print_verdicts(write_verdicts(options.results, claims))


def _compare(options: argparse.Namespace) -> int:
    from upswing.analysis.compare import compare
    from upswing.cli.terminal import print_comparison

    comparison = compare(options.a, options.b)
    print_comparison(comparison)
    return 1 if comparison.changed_verdicts else 0


def _browse(options: argparse.Namespace) -> None:
    from upswing.recordings.catalog import catalog, show
    from upswing.recordings.lending import PAGE, lending
    from upswing.recordings.selection import select
    from upswing.runs.results import Results

    results = Results(options.results)
    runs = select(results, options.filter)
    if options.print:
        print("\n".join(str(options.results / recording) for recording in runs["recording"]))
        return
    with (
        catalog(results, runs, options.port) as served,
        lending(results, options.report_port) as lent,
    ):
        if (options.results / PAGE).exists():
            print(f"the report, in which every run opens: {lent.page}", flush=True)
        show(served, options.web, options.web_port)


def _figure(options: argparse.Namespace) -> None:
    from upswing.figures import draw

    draw(options.figure, options.results)


def _screenshots(options: argparse.Namespace) -> None:
    from upswing.recordings.screenshots import take_screenshots
    from upswing.runs.results import Results

    take_screenshots(Results(options.results), options.into, options.run, options.task)


def _comparisons(options: argparse.Namespace) -> None:
    from upswing.recordings.comparison import write_comparisons
    from upswing.runs.results import Results

    for path in write_comparisons(Results(options.results)):
        print(path)


def _viewer(options: argparse.Namespace) -> None:
    from upswing.recordings.viewer import write_viewer
    from upswing.runs.results import Results

    for name in write_viewer(Results(options.results), options.templates):
        print(name)


def _doctor(options: argparse.Namespace) -> int:
    from upswing.analysis.doctor import examine
    from upswing.cli.terminal import print_diagnosis

    diagnosis = examine(options.results)
    print_diagnosis(diagnosis)
    return 1 if diagnosis.findings else 0


def _clean_orphans(options: argparse.Namespace) -> None:
    from upswing.analysis.doctor import delete_orphans

    for path in delete_orphans(options.results):
        print(f"deleted {path}")


def _readme(options: argparse.Namespace) -> None:
    from upswing.report.readme import write_readme

    write_readme(options.results, options.templates, options.readme)


def _report(options: argparse.Namespace) -> None:
    from upswing.report.page import write_report

    write_report(options.results, options.templates)


def _sweep(options: argparse.Namespace) -> None:
    from upswing.runs.study_file import parse_study, read_study
    from upswing.runs.sweep import write_group
    from upswing.study.errors import near
    from upswing.study.sweeps import load_sweeps

    study = parse_study(options.study, "study") if options.study else read_study(options.results)
    sweeps = load_sweeps(options.sweeps, study)
    if options.sweep not in sweeps:
        raise BadInput(
            [f"{options.sweeps}: {options.sweep}: no such sweep; {near(options.sweep, sweeps)}"]
        )
    sweep = sweeps[options.sweep]
    print(write_group(options.results, study, options.sweep, sweep, options.group))


def _readings(options: argparse.Namespace) -> None:
    from upswing.analysis.robustness.results import write_readings
    from upswing.figures.readings import draw_readings
    from upswing.runs.study_file import read_study
    from upswing.study.claims import load_claims
    from upswing.study.sweeps import load_sweeps

    study = read_study(options.results)
    sweeps, claims = load_sweeps(options.sweeps, study), load_claims(options.claims, study)
    print(write_readings(options.results, sweeps, claims).to_string())
    draw_readings(options.results, sweeps)


def _bound(options: argparse.Namespace) -> None:
    from upswing.optimal.bound import write_bound

    write_bound(options.results)


def _changes(options: argparse.Namespace) -> None:
    from upswing.analysis.ablation import write_changes

    print(write_changes(options.results).to_string())


def _shortest(options: argparse.Namespace) -> None:
    from upswing.analysis.search import write_shortest
    from upswing.runs.study_file import parse_study

    study = parse_study(options.study, "study")
    print(write_shortest(study, options.results).to_string())


def _study(options: argparse.Namespace) -> None:
    from upswing.runs.study_file import write_study

    write_study(options.study, options.results)


def _check(options: argparse.Namespace) -> None:
    from upswing.study.check import checked
    from upswing.study.matrix import Matrix

    matrix = Matrix(checked(options.config, options.claims, options.sweeps))
    steps = sum(cell.task.steps * len(cell.seeds) for cell in matrix.cells.values())
    for cell in matrix.cells.values():
        print(f"{cell.cell:45} {len(cell.seeds):4} runs of {cell.task.steps:>9,} steps")
    print(f"{len(matrix.cells)} cells, {len(list(matrix.runs))} runs, {steps:,} steps")


def _schema(options: argparse.Namespace) -> None:
    from upswing.study.json_schema import schema

    print(json.dumps(schema(), indent=2, ensure_ascii=False))


def _keys(options: argparse.Namespace) -> None:
    from upswing.study.schema import reference

    print(reference(), end="")
