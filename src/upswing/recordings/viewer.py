"""A viewer of chosen recordings that needs no server: ``report/viewer/``, opened from plain files.

The viewer is the one that the installed Rerun serves, so it reads what this Rerun has written. What
starts it stands in ``report/viewer.html``; that interface is Rerun's own and may change with a version,
which is why a test opens the page in a browser.
"""

import gzip
import shutil
from pathlib import Path

from upswing.recordings.comparison import claim_names, task_names
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
from upswing.runs.files.ledger import seal
from upswing.runs.results import Results
from upswing.study.ids import recording_id
from upswing.study.paths import VIEWER, comparison


def write_viewer(results: Results, templates: Path) -> list[str]:
    """Write the page, the viewer and the chosen recordings; returns the recordings' names.

    Args:
        results: whose recordings are shown; figures, verdicts and comparisons must be there.
        templates: the folder with ``viewer.html``.
    """
    folder = results.folder / VIEWER
    beside = folder.with_name(f"{folder.name}.part")
    shutil.rmtree(beside, ignore_errors=True)
    for inner in (RECORDINGS, LAYOUTS):
        (beside / inner).mkdir(parents=True)
    page = with_hashes((templates / "viewer.html").read_text("utf-8"))
    (beside / "index.html").write_text(page, "utf-8")
    viewer = engine()
    (beside / "viewer.js").write_bytes(gzip.decompress(viewer.script))
    (beside / "engine.js").write_text(script_of_compressed("engine", viewer.program), "ascii")
    for task in sorted({cell.task.name for cell in results.cells.values()}):
        (beside / LAYOUTS / f"{task}.js").write_text(script_of_layout(results, task), "ascii")
    names = []
    for kind, one_of in (("task", task_names(results)), ("claim", claim_names(results))):
        for each in one_of:
            names.append(f"{kind}-{each}")
            recording = results.folder / comparison(names[-1])
            _write_script(beside, names[-1], script_of(names[-1], recording.read_bytes()))
    for run in chosen_runs(results):
        names.append(recording_id(run))
        _write_script(beside, names[-1], script_of_run(results, run))
    shutil.rmtree(folder, ignore_errors=True)
    beside.rename(folder)
    seal(results.folder, "viewer", [folder])
    return names


def _write_script(folder: Path, name: str, script: str) -> None:
    (folder / RECORDINGS / f"{name}.js").write_text(script, "ascii")
