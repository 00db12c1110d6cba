"""Which commands a page names: those that make, judge and draw the very study that it is of."""

import shlex
from pathlib import Path
from typing import NamedTuple

from upswing.study.config import Study, load
from upswing.study.errors import BadInput

RESULTS = "results"
"""The folder that every subcommand takes where none is named."""

TARGETS = {
    "config.yaml": "make reproduce",
    "smoke.yaml": "make smoke",
    "beyond.yaml": "make beyond",
}
"""Configurations with a target of their own in the Makefile."""

UNKNOWN = "CONFIG.yaml"
"""What stands for a configuration that is not beside the others."""


class Commands(NamedTuple):
    """The commands of a study."""

    make: str  # makes all of it
    folder: (
        str  # what follows a subcommand, so that it takes this study's folder; empty for the first
    )
    browse: str  # opens its recordings, with its page
    snakemake: str  # writes Snakemake's own report


def commands(study: Study, configurations: Path) -> Commands:
    """The commands of a study.

    Args:
        study: the study; its folder of results is what tells it from others.
        configurations: the folder of configurations, in which its own is looked for.
    """
    if study.results == RESULTS:
        return Commands("make reproduce", "", "make browse", "make snakemake-report")
    path = configuration_of(study, configurations)
    file = shlex.quote(str(path)) if path else UNKNOWN
    made = TARGETS.get(path.name) if path else None
    folder = shlex.quote(study.results)
    return Commands(
        made or f"make study CONFIG={file}",
        f" --results {folder}",
        f".venv/bin/upswing browse --web --results {folder}",
        f".venv/bin/snakemake --configfile {file} --report {folder}/report/snakemake.html",
    )


def configuration_of(study: Study, configurations: Path) -> Path | None:
    """The configuration whose results are a study's; None where there is none in the folder."""
    for path in sorted(configurations.glob("*.yaml")):
        try:
            if load(path).results == study.results:
                return path
        except BadInput:
            continue  # claims or readings, or a study that is not finished
    return None
