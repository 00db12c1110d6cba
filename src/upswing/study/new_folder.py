"""A folder for studies of one's own, without a checkout: the rules come with the installed package."""

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

COPIED = ("config", "workflow/profiles")
"""What belongs to a study: its configuration with its claims, and how Snakemake runs it."""

TEMPLATES = ("report", "CITATION.cff")
"""What belongs to the page. A copy of one's own is used instead of the package's."""


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
        (beside / "Snakefile").write_text(SNAKEFILE, "utf-8")
        beside.replace(folder)
    finally:
        shutil.rmtree(beside, ignore_errors=True)
    return ["Snakefile", *copied]
