"""The project's own files: workflow, configurations, claims, templates. They come with the package.

In a checkout ``upswing/project`` has links to them; an installed package has the files themselves.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from upswing.study.errors import BadInput, shown
from upswing.study.places import CLAIMS, CONFIG, SWEEPS, TEMPLATES

PROJECT = Path(__file__).parents[1] / "project"
"""Where they come along, laid out as in a checkout."""

SNAKEFILE = str((PROJECT / "Snakefile").resolve())
"""The workflow's file, for a Snakefile of one's own that includes it or has it as a module."""


class Files(NamedTuple):
    """What the rules read besides results."""

    claims: Path
    sweeps: Path
    templates: Path
    config: Path  # the study where none is given


NAMED = ("claims", "sweeps", "templates")
"""The keys by which a workflow that has the rules as a module names files of its own."""


def along(path: Path, project: Path = PROJECT) -> Path:
    """A file of the working folder, or, where there is none, the one that comes with the project."""
    own = project / path
    return path if path.exists() or not own.exists() else own.resolve()


def is_own(path: Path) -> bool:
    """Whether a file is one of the installed package, which belongs to no study."""
    return path.resolve().is_relative_to(PROJECT.resolve())


def files_of_workflow(project: Path) -> Files:
    """What the rules in ``project`` read: of the working folder, else of their project."""
    place = _place(project)
    return Files(*(along(path, place) for path in (CLAIMS, SWEEPS, TEMPLATES, CONFIG)))


def files_of_module(project: Path, config: Mapping[str, Any]) -> tuple[Files, dict[str, Any]]:
    """What the rules in ``project`` read where another workflow uses them, and its configuration.

    The other workflow's own ``config`` and ``report`` are not meant: files are the project's, but for
    those that its configuration names as ``claims``, ``sweeps`` and ``templates``.

    Raises:
        BadInput: one of these is no path, or not there.
    """
    place, study = _place(project), dict(config)
    found = Files(place / CLAIMS, place / SWEEPS, place / TEMPLATES, place / CONFIG)
    problems = []
    for name in (name for name in NAMED if name in study):
        given = study.pop(name)
        if isinstance(given, str | Path) and Path(given).exists():
            found = found._replace(**{name: Path(given)})
            if name == "claims":
                study[name] = str(given)  # the study's own, which its results must know
        else:
            what = "a folder" if name == "templates" else "a file"
            problems.append(f"config of the module: {name}: {shown(given)}: must be {what}")
    if problems:
        raise BadInput(problems)
    return found, study


def _place(project: Path) -> Path:
    """The folder of the project that rules belong to; the package's, where they are not on this disk."""
    return project if (project / CLAIMS).exists() else PROJECT.resolve()
