"""The ids of cells and runs, and the paths of a run's files: nowhere else is one built or taken apart.

A cell is ``{task}/{architecture}/alpha-{alpha}``, a run ``{cell}/seed-{seed}``; below ``runs`` these are
also its paths.
"""

import re
from typing import NamedTuple

from upswing.study.names import NO_ALPHA, alpha_text

RUN_FILES = ("trajectory.parquet", "windows.parquet", "weights.safetensors", "rrd")
"""The endings of a run's files."""

KNOWN_FILE = "windows.parquet"
"""The one that the workflow knows. It is written last and says what the others are; so a plan has a
quarter of the files. Where one of the others is missing, ``runs/records.py`` has the job run again."""


class CellId(NamedTuple):
    """A cell's id in its parts."""

    task: str
    architecture: str
    alpha: str  # as it is written in the id; ``none`` for a control

    @classmethod
    def parse(cls, cell: str) -> "CellId":
        """The parts of the id of a cell."""
        task, architecture, alpha = cell.split("/")
        return cls(task, architecture, alpha.removeprefix("alpha-"))

    @property
    def label(self) -> str:
        """The cell without its task, for readers: ``table, α = 0.75``."""
        return (
            self.architecture
            if self.alpha == NO_ALPHA
            else f"{self.architecture}, α = {self.alpha}"
        )


class Named(NamedTuple):
    """The cell, or the run, that somebody named."""

    cell: str
    seed: int | None  # None: the cell


_NAMED = re.compile(
    rf"(?:.*/)?([^/]+/[^/]+/alpha-(?:[0-9]+(?:\.[0-9]+)?|{NO_ALPHA}))(?:/seed-([0-9]+))?/?"
)


def named_by(text: str) -> Named | None:
    """What an id names, or a path that ends with one or with a file of a run; None if neither."""
    for ending in RUN_FILES:
        text = text.removesuffix(f".{ending}")
    found = _NAMED.fullmatch(text)
    return None if found is None else Named(found[1], None if found[2] is None else int(found[2]))


def cell_id(task: str, architecture: str, alpha: float | None) -> str:
    """The id of a cell."""
    return f"{task}/{architecture}/alpha-{alpha_text(alpha)}"


def run_id(cell: str, seed: int) -> str:
    """The id of a run."""
    return f"{cell}/seed-{seed}"


def cell_of(run: str) -> str:
    """The id of a run's cell."""
    return run.rpartition("/")[0]


def seed_of(run: str) -> int:
    """A run's seed."""
    return int(run.rpartition("/seed-")[2])


def file_of(run: str, kind: str) -> str:
    """The path of a run's file below the folder of results; ``kind`` is one of ``RUN_FILES``."""
    return f"runs/{run}.{kind}"


def recording_of(run: str) -> str:
    """The path of a run's recording below the folder of results."""
    return file_of(run, "rrd")


def run_of(recording: str) -> str:
    """The run of a recording's path; of an id, the id itself."""
    return "/".join(recording.removesuffix(".rrd").split("/")[-4:])


def recording_id(run: str) -> str:
    """The id of a run's recording; the viewer takes letters, digits, ``_`` and ``-`` only."""
    return run.replace("/", "_").replace(".", "-")
