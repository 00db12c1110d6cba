"""Where a result comes from: commit, package versions, machine."""

import json
import os
import platform
import subprocess
from dataclasses import asdict, dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path

PACKAGES = (
    "upswing", "numpy", "numba", "torch", "stable-baselines3", "pandas", "pyarrow", "rerun-sdk",
    "snakemake",
)  # fmt: skip
KEY = b"upswing"
"""The key of Parquet metadata under which all of ours is, as JSON."""


@dataclass(frozen=True)
class Provenance:
    """What there is to know about the making of a result, besides its specification."""

    git_commit: str  # "unknown" outside a checkout
    dirty: bool  # whether tracked files differed from the commit
    python: str
    packages: dict[str, str]
    machine: str
    processors: int

    def as_dict(self) -> dict[str, object]:
        """As plain values."""
        return asdict(self)


@cache
def provenance() -> Provenance:
    """The provenance of what this process makes."""
    commit = _git("rev-parse", "HEAD")
    return Provenance(
        git_commit=commit or "unknown",
        dirty=bool(_git("status", "--porcelain", "--untracked-files=no")),
        python=platform.python_version(),
        packages={name: version(name) for name in PACKAGES},
        machine=f"{platform.system()} {platform.machine()}",
        processors=os.cpu_count() or 0,
    )


def metadata(**more: object) -> dict[bytes, bytes]:
    """Parquet metadata: the provenance, and what else belongs to the file."""
    content = {"provenance": provenance().as_dict(), **more}
    return {KEY: json.dumps(content, sort_keys=True).encode()}


def _git(*arguments: str) -> str:
    """What git answers about the checkout this package is in; empty outside one."""
    here = Path(__file__).resolve().parent
    try:
        answer = subprocess.run(
            # Without its optional lock: a job that is killed must not leave one in the repository.
            ["git", "--no-optional-locks", "-C", str(here), *arguments],
            capture_output=True,
            text=True,
            check=True,
        )
    except (OSError, subprocess.CalledProcessError):
        return ""
    return answer.stdout.strip()
