"""Whether a folder may take results: a new one, an empty one, or one that is a study's own already.

A study writes and replaces files, and orphans are deleted: in a folder of something else that would be
damage.
"""

from pathlib import Path

from upswing.study.errors import BadInput, shown
from upswing.study.paths import STUDY

OURS = (
    "adopted", "benchmarks", "checksums", "figures", "history", "logs", "readings", "recordings",
    "report", "runs", "study.json", "tables", "README.md", ".kept", ".gitignore", ".gitkeep",
)  # fmt: skip
"""What a study leaves in its folder, or the project has put there."""

PROJECT = (
    ".ci", ".git", ".github", ".snakemake", ".venv", "config", "docs", "report", "src", "tests",
    "workflow",
)  # fmt: skip
"""Folders of the project, below the one it is run in."""


def check_results(results: str | Path, source: str) -> None:
    """Refuse a folder that is not for results; ``source`` says where it is written.

    Raises:
        BadInput: it is the project's own, holds something else, is a file, or cannot be looked at.
    """
    if reason := _reason(Path(results)):
        right = f"{reason}; give a folder that is new, empty or a study's own"
        raise BadInput([f"{source}: results: {shown(str(results))}: {right}"])


def _reason(folder: Path) -> str | None:
    try:
        place, here = folder.resolve(), Path.cwd().resolve()
        if not folder.exists():
            if folder.is_symlink():
                return "is a link that leads nowhere"
            if place == here or place in here.parents:
                return "is the project's own folder, or above it"
        elif not folder.is_dir():
            return "is a file"
    except (OSError, RuntimeError) as error:
        reason = (
            error.strerror if isinstance(error, OSError) and error.strerror else "a loop of links"
        )
        return f"cannot be looked at: {reason}"
    if place == here or place in here.parents:
        return "is the project's own folder, or above it"
    if place.is_relative_to(here) and place.relative_to(here).parts[0] in PROJECT:
        return f"is in {place.relative_to(here).parts[0]}/, which is not for results"
    if any(above.exists() and not above.is_dir() for above in place.parents):
        return "is below a file"
    for study, part in zip(place.parents, (place, *place.parents), strict=False):
        if part.name in OURS and (study / STUDY).exists():
            return f"is a part of the results in {study.name}"
    if not place.is_dir() or (place / STUDY).exists():
        return None
    try:
        others = sorted(
            path.name
            for path in place.iterdir()
            if path.name not in OURS and not (path / STUDY).exists()
        )
    except OSError as error:
        return f"cannot be looked at: {error.strerror}"
    return f"holds something else ({shown(others[0])})" if others else None
