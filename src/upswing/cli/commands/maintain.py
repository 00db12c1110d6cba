"""Keep a folder of results whole, and what is generated from results and code up to date."""

import json
from pathlib import Path
from typing import Annotated

import typer

from upswing.cli.options import (
    Claims,
    Named,
    Positional,
    Sweeps,
    Templates,
    claims_of,
    needs_checkout,
    results_folder,
)
from upswing.cli.panel import Panel
from upswing.study.places import SWEEPS, TEMPLATES

panel = Panel("Maintain")


@panel.subcommand("doctor")
def doctor(positional: Positional = None, results: Named = None, claims: Claims = None) -> int:
    """Check that a folder of results is whole; says what to delete where it is not."""
    from upswing.analysis.doctor import examine
    from upswing.cli.shown.folders import print_diagnosis

    folder = results_folder(results, positional)
    diagnosis = examine(folder, claims)
    print_diagnosis(diagnosis, folder)
    return 1 if diagnosis.findings else 0


@panel.subcommand("clean-orphans")
def clean_orphans(
    positional: Positional = None,
    results: Named = None,
    yes: Annotated[bool, typer.Option("--yes", help="Delete them; without, only list.")] = False,
) -> None:
    """List the files of runs that are not, or no longer, in the study; delete them with --yes."""
    from upswing.analysis.doctor import delete_orphans, orphans_of
    from upswing.cli.shown.folders import print_orphans

    folder = results_folder(results, positional)
    found = delete_orphans(folder) if yes else orphans_of(folder)
    print_orphans(found, folder, deleted=yes)


@panel.subcommand("readme")
def readme(
    positional: Positional = None,
    results: Named = None,
    templates: Templates = TEMPLATES,
    readme: Annotated[Path, typer.Option(metavar="FILE", help="The file that is renewed.")] = Path(
        "README.md"
    ),
    claims: Claims = None,
    sweeps: Sweeps = SWEEPS,
) -> None:
    """Renew what the README shows of the results."""
    from upswing.analysis.robustness.outdated import outdated
    from upswing.analysis.robustness.tables import SHIPPED
    from upswing.report.readme import write_readme
    from upswing.runs.study_file import read_study
    from upswing.study import jobs
    from upswing.study.errors import BadInput
    from upswing.study.paths import ROBUST
    from upswing.study.registration import of
    from upswing.study.sweeps import load_sweeps

    needs_checkout("upswing readme", templates, readme)
    folder = results_folder(results, positional)
    study = read_study(folder)
    if study.claims or study.title or not study.judges:
        raise BadInput([f"{folder}: is of a study of one's own; the README shows the thesis's"])
    judged, swept = claims_of(study, claims), load_sweeps(sweeps, study)
    old = outdated(folder, swept, judged, study).changed if (folder / ROBUST).exists() else []
    if old:
        print(
            f"{templates / SHIPPED} stays as it is: {', '.join(old)} changed since the sweeps were run; "
            "`make readings` runs them again"
        )
    codes = {f"code of {name}": jobs.sweep(one, study).fingerprint for name, one in swept.items()}
    made_from = {"sweeps": of(study, judged, swept).sweeps, **codes}
    write_readme(folder, templates, readme, None if old else judged, made_from)


@panel.subcommand("site")
def site(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="What is written; an earlier site is replaced.")
    ],
    results: Named = None,
    templates: Templates = TEMPLATES,
) -> None:
    """Write the report with its recordings as a folder for any host of static files."""
    from upswing.report.site import write_site

    files = write_site(results_folder(results), templates, folder)
    size = sum((folder / file).stat().st_size for file in files) / 1e6
    print(f"{folder}: {len(files)} files, {size:.0f} MB; {folder / 'index.html'} is the page")


@panel.subcommand("exploratory")
def exploratory(
    positional: Positional = None, results: Named = None, templates: Templates = TEMPLATES
) -> None:
    """Keep the verdicts of a study on seeds that were seen before, to be shown beside others."""
    from upswing.report.exploratory import write_exploratory

    needs_checkout("upswing exploratory", templates)
    print(write_exploratory(results_folder(results, positional), templates))


@panel.subcommand("screenshots")
def screenshots(
    positional: Positional = None,
    results: Named = None,
    into: Annotated[
        Path, typer.Option(metavar="FOLDER", help="Where the pictures are put.")
    ] = Path("docs/pictures"),
    run: Annotated[
        str, typer.Option(help="The run that is shown.")
    ] = "full-control/table/alpha-0.01/seed-10004",
    task: Annotated[str, typer.Option(help="The task whose runs are compared.")] = "full-control",
) -> None:
    """Take the README's pictures of the recordings, in a viewer without a screen."""
    from upswing.recordings.screenshots import take_screenshots
    from upswing.runs.results import Results

    needs_checkout("upswing screenshots", into)
    take_screenshots(Results(results_folder(results, positional)), into, run, task)


@panel.subcommand("schema")
def schema() -> None:
    """Print the JSON schema of a configuration."""
    from upswing.study.json_schema import schema

    print(json.dumps(schema(), indent=2, ensure_ascii=False))


@panel.subcommand("keys")
def keys() -> None:
    """Print what every key of a configuration means, in Markdown."""
    from upswing.study.key_reference import reference

    print(reference(), end="")
