"""The page as a folder for any host of static files: page, tables, viewer and its recordings.

All links are relative, and what only a server of ours could answer is no link. The folder is made beside
its place and then renamed, so that it is whole or as it was.
"""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from upswing.report.chapter import chapter
from upswing.report.page import page_of
from upswing.study.errors import BadInput
from upswing.study.paths import BEYOND, EVIDENCE_CSV, PAGE, RUNS_CSV, VIEWER, VIEWER_PAGE

CITATION, LICENSE = "CITATION.cff", "LICENSE"
NO_JEKYLL = ".nojekyll"
"""Tells GitHub's host to hand the files out as they are."""

NAMES = tuple(Path(name).name for name in (PAGE, RUNS_CSV, EVIDENCE_CSV))
OURS = frozenset((*NAMES, Path(VIEWER).name, BEYOND, CITATION, LICENSE, NO_JEKYLL))
"""All that a site has at its top; a folder with anything else is none of ours."""


def write_site(results: Path, templates: Path, site: Path) -> list[Path]:
    """Write the site of a study, with the chapter beyond it where that was run.

    Args:
        results: the folder of results, with its viewer.
        templates: the folder of templates, styles and texts.
        site: the folder to write; an earlier site there is replaced.

    Returns:
        The files, relative to ``site``.

    Raises:
        BadInput: the results lack what the site shows, or ``site`` holds something else.
    """
    _may_replace(site)
    folders = {".": results}
    if chapter(results)["folder"] == results / BEYOND:
        folders[BEYOND] = results / BEYOND
    for place, folder in folders.items():
        if not (folder / VIEWER_PAGE).is_file():
            made_by = "make beyond" if place == BEYOND else "make reproduce"
            raise BadInput([f"{folder / VIEWER_PAGE}: missing; `{made_by}` makes it"])
    with _made_beside(site) as made:
        for place, folder in folders.items():
            page = page_of(folder, templates, lent=False, chapter_at=f"{BEYOND}/")
            page.write(made / place, *NAMES)
            shutil.copytree(folder / VIEWER, made / place / Path(VIEWER).name)
        for name in (CITATION, LICENSE):
            if (own := templates.parent / name).is_file():
                shutil.copyfile(own, made / name)
        (made / NO_JEKYLL).touch()
    return sorted(path.relative_to(site) for path in site.rglob("*") if path.is_file())


def _may_replace(site: Path) -> None:
    if not site.exists():
        return
    if not site.is_dir():
        raise BadInput([f"{site}: is a file; name a folder"])
    found = {path.name for path in site.iterdir()}
    if found and (NO_JEKYLL not in found or not found <= OURS):
        other = min(found - OURS, default="no site")
        raise BadInput([f"{site}: holds something else ({other}); name a folder of its own"])


@contextmanager
def _made_beside(folder: Path) -> Iterator[Path]:
    """A folder to fill; it takes the place of ``folder`` if the block ends well, and vanishes if not."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    made, before = (
        folder.with_name(f".{folder.name}.{os.getpid()}.{end}") for end in ("part", "old")
    )
    made.mkdir()
    try:
        yield made
        if folder.exists():
            folder.rename(before)
        made.rename(folder)
    finally:
        shutil.rmtree(made, ignore_errors=True)
        if before.exists() and not folder.exists():  # it could not be replaced
            before.rename(folder)
        shutil.rmtree(before, ignore_errors=True)
