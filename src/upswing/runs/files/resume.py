"""Runs that were finished when another run of their job failed, kept for the next try.

Snakemake deletes all outputs of a job that fails, and before it runs it again. So the finished ones are
linked aside, with what they are of, and taken back when the same is asked for again.
"""

import json
import os
import shutil
from pathlib import Path

from upswing.runs.files.checksums import checksum

FOLDER = ".kept"


def keep(results: Path, run: str, identity: str, files: list[Path]) -> None:
    """Link the ``files`` of a finished run aside; ``identity`` is its specification and code."""
    place = results / FOLDER / run
    shutil.rmtree(place, ignore_errors=True)
    place.mkdir(parents=True)
    for file in files:
        os.link(file, place / file.name)
    note = {"identity": identity, "checksums": {file.name: checksum(file) for file in files}}
    (place / "note.json").write_text(json.dumps(note), "utf-8")


def take_back(results: Path, run: str, identity: str, target: Path) -> bool:
    """Put the files of a kept run into the folder ``target``; whether they were there, and whole.

    What was kept is gone afterwards, whether it could be used or not.
    """
    place = results / FOLDER / run
    try:
        note = json.loads((place / "note.json").read_text("utf-8"))
        whole = note["identity"] == identity and all(
            checksum(place / name) == recorded for name, recorded in note["checksums"].items()
        )
        if whole:
            target.mkdir(parents=True, exist_ok=True)
            for name in note["checksums"]:
                (place / name).replace(target / name)
    except (OSError, ValueError, KeyError, TypeError):
        whole = False
    shutil.rmtree(place, ignore_errors=True)
    return whole
