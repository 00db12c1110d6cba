"""Which commands a page names: those that make, judge and draw the very study that it is of."""

import shlex
from pathlib import Path, PurePosixPath
from typing import NamedTuple

from upswing.study.config import Study, load
from upswing.study.errors import BadInput

RESULTS = "results"
"""The folder that every subcommand takes where none is named."""

FIRST = "config.yaml"
"""The configuration that Snakemake takes where none is named."""

TARGETS = {
    FIRST: "make reproduce",
    "smoke.yaml": "make smoke",
    "beyond.yaml": "make beyond",
}
"""Configurations with a target of their own in the Makefile."""

UNKNOWN = "CONFIG.yaml"
"""What stands for a configuration that is not beside the others."""

MAKEFILE = Path("Makefile")
"""What a checkout has. A folder of `upswing init` has none, and no environment of its own."""


class Commands(NamedTuple):
    """The commands of a study."""

    make: str  # makes all of it
    folder: (
        str  # what follows a subcommand, so that it takes this study's folder; empty for the first
    )
    browse: str  # opens its recordings, with its page
    snakemake: str  # writes Snakemake's own report
    upswing: str  # the program


class Configuration(NamedTuple):
    """Where a study is configured."""

    path: Path
    elsewhere: bool  # whether its results lie in a folder that somebody named beside it


def commands(study: Study, configurations: Path, makefile: Path = MAKEFILE) -> Commands:
    """The commands of a study.

    Args:
        study: the study; its folder of results is what tells it from others.
        configurations: the folder of configurations, in which its own is looked for.
        makefile: where it is there, `make` makes the study, and else Snakemake.
    """
    found = configuration_of(study, configurations)
    folder = "" if study.results == RESULTS else f" --results {shlex.quote(study.results)}"
    if makefile.exists():
        return _of_checkout(study, found, folder)
    first = found is not None and found.path.name == FIRST
    words = "" if first else f" --configfile {_file(found)}"
    if found and found.elsewhere:
        words += f" --config results={shlex.quote(study.results)}"
    report = shlex.quote(f"{study.results}/report/snakemake.html")
    return Commands(
        f"snakemake --cores all{words}",
        folder,
        f"upswing browse --web{folder}",
        f"snakemake{words} --report {report}",
        "upswing",
    )


def _of_checkout(study: Study, found: Configuration | None, folder: str) -> Commands:
    upswing = ".venv/bin/upswing"
    if not folder:
        return Commands("make reproduce", "", "make browse", "make snakemake-report", upswing)
    file, made = _file(found), TARGETS.get(found.path.name) if found else None
    made, more = made or f"make study CONFIG={file}", ""
    if found and found.elsewhere:
        # These two lie below the folder that was named.
        named = PurePosixPath(study.results)
        below = made in ("make smoke", "make beyond") and made.endswith(f" {named.name}")
        made += f" RESULTS={shlex.quote(str(named.parent if below else named))}"
        more = f" --config results={shlex.quote(study.results)}"
    report = shlex.quote(f"{study.results}/report/snakemake.html")
    return Commands(
        made,
        folder,
        f"{upswing} browse --web{folder}",
        f".venv/bin/snakemake --configfile {file}{more} --report {report}",
        upswing,
    )


def _file(found: Configuration | None) -> str:
    return shlex.quote(str(found.path)) if found else UNKNOWN


def configuration_of(study: Study, configurations: Path) -> Configuration | None:
    """The configuration of a study; None where there is none in the folder.

    It is the one whose results are the study's, or else one that asks for the same with its results
    elsewhere.
    """
    same = None
    for path in sorted(configurations.glob("*.yaml")):
        try:
            asked = load(path)
        except BadInput:
            continue  # claims or readings, or a study that is not finished
        if asked.results == study.results:
            return Configuration(path, elsewhere=False)
        if same is None and asked.model_copy(update={"results": study.results}) == study:
            same = Configuration(path, elsewhere=True)
    return same
