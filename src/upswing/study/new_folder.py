"""A folder for studies of one's own, without a checkout: the rules come with the installed package."""

import re
import shutil
from pathlib import Path

from upswing.study.errors import BadInput
from upswing.study.project_files import PROJECT

SNAKEFILE = """\
# A study of upswing: `snakemake --cores all` makes the one in config/config.yaml,
# `snakemake --cores all --configfile config/smoke.yaml` another. The rules come with the package.

from upswing.study.project_files import SNAKEFILE


include: SNAKEFILE


rule default:
    input:
        rules.all.input,
"""

README = """\
# Studies with upswing

    snakemake --cores all --configfile config/smoke.yaml   # a short study: does it work?
    snakemake --cores all                                  # the study of the thesis
    upswing check config/mine.yaml                         # what is wrong, and what it comes to
    snakemake --cores all --configfile config/mine.yaml    # makes it
    upswing browse --web --results results/mine            # opens its page and its recordings

Begin with a copy of `config/template.yaml`. Every key is explained in `config/README.md`. A study's
page is `report/index.html` in its folder of results.
"""

CONFIGURATIONS = (
    "README.md", "accelerations.yaml", "beyond-claims.yaml", "beyond.yaml", "claims.yaml", "config.yaml",
    "poles.yaml", "readings.yaml", "registration.yaml", "schema.json", "smoke.yaml", "template.yaml",
    "time-steps.yaml",
)  # fmt: skip
"""The project's own files of ``config``: a checkout may hold somebody's besides."""

COPIED = (*(f"config/{name}" for name in CONFIGURATIONS), "workflow/profiles")
"""What belongs to a study: its configuration with its claims, and how Snakemake runs it."""

TEMPLATES = ("report", "CITATION.cff")
"""What belongs to the page. A copy of one's own is used instead of the package's."""

COMMANDS = (
    (re.compile(r"\.venv/bin/upswing"), "upswing"),
    (re.compile(r"make study CONFIG=(\S+\.yaml)"), r"snakemake --cores all --configfile \1"),
    (re.compile(r"make (beyond|smoke)\b"), r"snakemake --cores all --configfile config/\1.yaml"),
    (re.compile(r"make reproduce"), "snakemake --cores all"),
    (re.compile(r"make readings"), "snakemake --cores all with_readings"),
)  # fmt: skip
"""Commands of a checkout, and what they are where there is no Makefile."""


def write_folder(folder: Path, templates: bool = False) -> list[str]:
    """Write a folder in which Snakemake makes studies; returns what it holds.

    Args:
        folder: a new one, or one that is empty.
        templates: whether the page's templates are copied too, to be changed.

    Raises:
        BadInput: it holds something, or the package came without the project's files.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise BadInput([f"{folder}: is not empty; give a folder that is new or empty"])
    copied = (*COPIED, *(TEMPLATES if templates else ()))
    if lost := [name for name in copied if not (PROJECT / name).exists()]:
        raise BadInput([f"{PROJECT / lost[0]}: missing: this package came without it"])
    folder.parent.mkdir(parents=True, exist_ok=True)
    beside = folder.parent / f".{folder.name}.part"
    shutil.rmtree(beside, ignore_errors=True)
    try:
        for name in copied:
            source, place = PROJECT / name, beside / name
            place.parent.mkdir(parents=True, exist_ok=True)
            (shutil.copytree if source.is_dir() else shutil.copy)(source, place)
        for path in (p for p in beside.rglob("*") if p.suffix in (".yaml", ".md")):
            path.write_text(without_make(path.read_text("utf-8")), "utf-8")
        (beside / "Snakefile").write_text(SNAKEFILE, "utf-8")
        (beside / "README.md").write_text(README, "utf-8")
        beside.replace(folder)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
    return sorted({"Snakefile", "README.md", *(Path(name).parts[0] for name in copied)})


def without_make(text: str) -> str:
    """A text in which the commands of a checkout are those of a folder that has no Makefile."""
    for command, otherwise in COMMANDS:
        text = command.sub(otherwise, text)
    return text
