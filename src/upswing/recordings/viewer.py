"""A viewer of chosen recordings that needs no server: ``report/viewer/``, opened from plain files.

The viewer is the one that the installed Rerun serves, so it reads what this Rerun has written. What
starts it stands in ``report/viewer.html``; that interface is Rerun's own and may change with a version,
which is why a test opens the page in a browser.
"""

import gzip
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import NamedTuple

from upswing.recordings.comparison_names import comparison_names
from upswing.recordings.content_policy import with_hashes
from upswing.recordings.engine import engine
from upswing.recordings.singly import (
    LAYOUTS,
    RECORDINGS,
    chosen_runs,
    script_of,
    script_of_compressed,
    script_of_layout,
    script_of_run,
)
from upswing.runs.files.atomic import written
from upswing.runs.files.checksums import checksum
from upswing.runs.files.ledger import ledger_path, read_ledger, seal
from upswing.runs.results import Results
from upswing.study import jobs
from upswing.study.claims import Claim
from upswing.study.errors import BadInput
from upswing.study.ids import recording_id, recording_of
from upswing.study.paths import VIEWER, VIEWER_PAGE, comparison

LEDGER = "viewer"
"""The name of the viewer's ledger."""


class Shown(NamedTuple):
    """A recording that the page shows."""

    name: str
    source: Path
    script: Callable[[], str]  # makes what the page loads


def write_viewer(results: Results, claims: Mapping[str, Claim], templates: Path) -> list[str]:
    """Write the page, the viewer and the chosen recordings; returns the recordings' names.

    The script of a recording stays if this very code made it of this very recording; what is no longer
    shown goes.

    Args:
        results: whose recordings are shown; figures and comparisons must be there.
        claims: whose runs are shown.
        templates: the folder with ``viewer.html``.
    """
    folder = results.folder / VIEWER
    for inner in (RECORDINGS, LAYOUTS):
        (folder / inner).mkdir(parents=True, exist_ok=True)
    _write_engine(folder)
    tasks = sorted({cell.task.name for cell in results.cells.values()})
    for task in tasks:
        _write(folder / LAYOUTS / f"{task}.js", script_of_layout(results, task))
    before, code = _made_before(results.folder), jobs.VIEWER.fingerprint
    made: dict[str, str] = {}
    for name, source, script in _shown(results, claims):
        if not source.is_file():
            raise FileNotFoundError(f"{source}: missing; run the study again")
        made[name] = f"{code} {checksum(source)}"
        path = folder / RECORDINGS / f"{name}.js"
        if before.get(name) != made[name] or not path.is_file():
            _write(path, script())
    for inner, shown in ((RECORDINGS, [*made]), (LAYOUTS, tasks)):
        for path in (folder / inner).iterdir():
            if path.stem not in shown:
                path.unlink()
    page = with_hashes((templates / "viewer.html").read_text("utf-8"))
    _write(results.folder / VIEWER_PAGE, page)
    seal(results.folder, LEDGER, [folder], **made)
    return [*made]


def _shown(results: Results, claims: Mapping[str, Claim]) -> Iterator[Shown]:
    """The recordings that the page shows."""
    for name in comparison_names(claims, results.cells):
        path = results.folder / comparison(name)
        yield Shown(name, path, partial(_script_of_comparison, name, path))
    for run in chosen_runs(results, claims):
        path = results.folder / recording_of(run)
        yield Shown(recording_id(run), path, partial(script_of_run, results, run))


def _script_of_comparison(name: str, path: Path) -> str:
    return script_of(name, path.read_bytes())


def _made_before(results: Path) -> Mapping[str, str]:
    """Of each script that is there, the code and the recording that it was made of; empty if unknown."""
    try:
        return read_ledger(ledger_path(results, LEDGER)).made_from
    except BadInput:
        return {}


def _write_engine(folder: Path) -> None:
    """The viewer of the installed Rerun, if it is not that which is there."""
    viewer = engine()
    for name, content in (
        ("viewer.js", gzip.decompress(viewer.script).decode("utf-8")),
        ("engine.js", script_of_compressed("engine", viewer.program)),
    ):
        path = folder / name
        if not path.is_file() or path.read_bytes() != content.encode("utf-8"):
            _write(path, content)


def _write(path: Path, text: str) -> None:
    with written(path) as beside:
        beside.write_text(text, "utf-8")
