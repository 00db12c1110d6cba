"""A viewer of chosen recordings that needs no server: ``report/viewer/``, opened from plain files.

The viewer is the one that the installed Rerun serves, so it reads what this Rerun has written. What
starts it stands in ``report/viewer.html``; that interface is Rerun's own and may change with a version,
which is why a test opens the page in a browser.
"""

import gzip
from collections.abc import Callable, Mapping
from pathlib import Path

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
from upswing.runs.files.ledger import seal
from upswing.runs.results import Results
from upswing.study.claims import Claim
from upswing.study.ids import recording_id, recording_of
from upswing.study.paths import VIEWER, VIEWER_PAGE, comparison


def write_viewer(results: Results, claims: Mapping[str, Claim], templates: Path) -> list[str]:
    """Write the page, the viewer and the chosen recordings; returns the recordings' names.

    What is there already and newer than what it is made from stays, and what is no longer shown goes.

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
    names = []
    for name in comparison_names(claims, results.cells):
        source = results.folder / comparison(name)
        _renew(folder, name, source, lambda n=name, s=source: script_of(n, s.read_bytes()))  # type: ignore[misc]
        names.append(name)
    for run in chosen_runs(results, claims):
        source = results.folder / recording_of(run)
        _renew(folder, recording_id(run), source, lambda r=run: script_of_run(results, r))  # type: ignore[misc]
        names.append(recording_id(run))
    for inner, shown in ((RECORDINGS, names), (LAYOUTS, tasks)):
        for path in (folder / inner).iterdir():
            if path.stem not in shown:
                path.unlink()
    page = with_hashes((templates / "viewer.html").read_text("utf-8"))
    _write(results.folder / VIEWER_PAGE, page)
    seal(results.folder, "viewer", [folder])
    return names


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


def _renew(folder: Path, name: str, source: Path, script: Callable[[], str]) -> None:
    """Write the script of a recording, if it is older than the recording."""
    path = folder / RECORDINGS / f"{name}.js"
    if not source.is_file():
        raise FileNotFoundError(f"{source}: missing; run the study again")
    if not path.is_file() or path.stat().st_mtime_ns <= source.stat().st_mtime_ns:
        _write(path, script())


def _write(path: Path, text: str) -> None:
    with written(path) as beside:
        beside.write_text(text, "utf-8")
