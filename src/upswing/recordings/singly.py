"""Recordings handed out singly, as scripts: a page that is opened from a file may load nothing else.

A run's recording is handed out as it is, byte for byte: the one whose checksum the run has. Its layout
is a script of its own, one for each task. (Rerun could merge the two, into other bytes each time.)
"""

import base64
import gzip
import json
from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from upswing.runs.recording.layout import run_layout
from upswing.runs.results import Results
from upswing.study.claims import Claim
from upswing.study.ids import cell_of, recording_id, recording_of
from upswing.study.paths import FIGURES

RECORDINGS, LAYOUTS = "recordings", "layouts"
"""The folders of the scripts, beside the page that loads them."""


def chosen_runs(results: Results, claims: Mapping[str, Claim]) -> list[str]:
    """The runs that the report shows: those of its figures, and each claim's worst, median and best."""
    cells = dict.fromkeys(claim.cell for claim in claims.values() if claim.cell in results.cells)
    of_claims = [str(run) for cell in cells for run in results.three_of(str(cell))["run"]]
    words = [
        json.loads(path.read_text("utf-8"))
        for path in sorted((results.folder / FIGURES).glob("*.json"))
    ]
    # A figure may be left over from an earlier study.
    known = {cell.run(seed) for cell in results.cells.values() for seed in cell.seeds}
    shown = [run for figure in words for run in figure["runs"] if run in known]
    return list(dict.fromkeys([*shown, *of_claims]))


def script_of_run(results: Results, run: str) -> str:
    """A run's recording as a script, which names its layout.

    Raises:
        FileNotFoundError: the run has no recording.
    """
    recording = results.folder / recording_of(run)
    if not recording.is_file():
        raise FileNotFoundError(f"{recording}: missing; run the study again")
    task = results.cells[cell_of(run)].task.name
    return script_of(recording_id(run), recording.read_bytes(), task)


def script_of_layout(results: Results, task: str) -> str:
    """The layout of the runs of a task as a script."""
    of_task = next(cell.task for cell in results.cells.values() if cell.task.name == task)
    with TemporaryDirectory() as folder:
        layout = Path(folder) / "layout.rbl"
        run_layout(of_task).save(f"upswing-{task}", layout)
        return script_of("layout", layout.read_bytes())


def script_of(name: str, content: bytes, layout: str = "") -> str:
    """A recording as a script that hands it to the page, with the name of its layout."""
    return script_of_compressed(name, compressed(content), layout)


def script_of_compressed(name: str, content: bytes, layout: str = "") -> str:
    """What was compressed already as a script that hands it to the page."""
    return f'arrived("{name}","{base64.b64encode(content).decode("ascii")}","{layout}")\n'


def compressed(content: bytes) -> bytes:
    """With gzip; the same for the same content."""
    return gzip.compress(content, 6, mtime=0)
