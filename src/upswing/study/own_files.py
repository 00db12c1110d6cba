"""Files of one's own that a configuration names: claims, and code that draws figures.

They stand beside the configuration, in its folder or below it, so that who is given a configuration sees
what comes with it. Code is found by a figure's name alone: ``figures/NAME.py``.
"""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from upswing.study.errors import near, problem, shown
from upswing.study.loading import parts

CLAIMS, FIGURES = "claims", "figures"
"""The keys of a configuration that name files; the second is also the folder of the figures' code."""

Content = dict[str, Any]


def placed(source: str, content: Content, folder: Path, problems: list[str]) -> Content:
    """A configuration in which each file of its own is a path from the folder of the workflow.

    Args:
        source: whom a problem names.
        content: what the configuration says.
        folder: its folder.
        problems: what is wrong with files is added here; what is wrong is then left out.
    """
    content = dict(content)
    if isinstance(name := content.get(CLAIMS), str):
        path = folder / name
        if why := _why_not(path, folder):
            problems.append(problem(source, CLAIMS, name, why))
            del content[CLAIMS]
        else:
            content[CLAIMS] = _from_here(path)
    if isinstance(named := content.get(FIGURES), list):
        content[FIGURES] = list(_figures(source, named, folder, problems))
    return content


def _figures(source: str, named: list[Any], folder: Path, problems: list[str]) -> Iterator[Any]:
    """Figures as they are named, and in place of a name that a file here has, this file."""
    project = parts("figures")
    for number, name in enumerate(named):
        place = f"{FIGURES}[{number}]"
        if isinstance(name, Mapping) and "file" in name:
            right = (
                f"unknown key: write the name alone; {folder / FIGURES}/NAME.py is then its code"
            )
            problems.append(f"{source}: {place}.file: {right}")
            continue
        if not isinstance(name, str):
            yield name
            continue
        own = own_figures(folder)
        if name in project and name in own:
            right = "the project has a figure of this name; give yours another"
            problems.append(problem(source, place, name, right))
        elif name in own:
            if why := _why_not(own[name], folder):
                problems.append(problem(source, place, name, f"{own[name]}: {why}"))
            else:
                yield {"name": name, "file": _from_here(own[name])}
        elif name in project:
            yield name
        else:
            right = f"no such figure, in {folder / FIGURES} or in the project"
            problems.append(
                problem(source, place, name, f"{right}; {near(name, [*own, *project])}")
            )


def _from_here(path: Path) -> str:
    """A file's path from the working folder if it lies below it: Snakemake names files from the root."""
    here = Path.cwd()
    return (path.relative_to(here) if path.is_relative_to(here) else path).as_posix()


def own_figures(folder: Path) -> dict[str, Path]:
    """The files of figures beside a configuration, by the names of the figures."""
    files = sorted((folder / FIGURES).glob("[a-z]*.py"))
    return {path.stem.replace("_", "-"): path for path in files}


def _why_not(path: Path, folder: Path) -> str:
    """Why a configuration in ``folder`` may not name a file; empty if it may."""
    try:
        there = path.is_file()
    except (OSError, ValueError):  # too long, or with a NUL
        return f"cannot be the name of a file: {shown(path.name)}"
    if not path.resolve().is_relative_to(folder.resolve()):
        return f"must lie in {folder}, beside the configuration, or below it"
    return "" if there else f"there is no such file in {folder}"
