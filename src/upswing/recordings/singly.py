"""Recordings handed out singly: with their layout in them, and as scripts that a plain page loads."""

import base64
import gzip
import json
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

from upswing.recordings.layout import run_layout
from upswing.recordings.names import VIEWER, recording_id
from upswing.runs import Results
from upswing.tables import read_verdicts


def chosen_runs(results: Results) -> list[str]:
    """The runs that the report shows: those of its figures, and each claim's worst, median and best."""
    verdicts = read_verdicts(results.folder)
    of_claims = [
        str(path).removeprefix("runs/").removesuffix(".rrd")
        for paths in verdicts["recordings"]
        for path in paths
    ]
    words = [
        json.loads(path.read_text("utf-8"))
        for path in sorted((results.folder / "figures").glob("*.json"))
    ]
    known = set(results.runs["run"])  # a figure may be left over from an earlier study
    shown = [run for figure in words for run in figure["runs"] if run in known]
    return list(dict.fromkeys([*shown, *of_claims]))


def with_layout(results: Results, run: str) -> bytes:
    """A run's recording with the layout in it, as one whole file.

    Raises:
        FileNotFoundError: the run has no recording.
    """
    recording = results.folder / "runs" / f"{run}.rrd"
    if not recording.is_file():
        raise FileNotFoundError(f"{recording}: missing; run the study again")
    task = results.cells[run.rsplit("/", 1)[0]].task
    with TemporaryDirectory() as folder:
        layout, merged = Path(folder) / "layout.rbl", Path(folder) / "merged.rrd"
        run_layout(task.kind).save(f"upswing-{task.name}", layout)
        command = [str(VIEWER), "rrd", "merge", str(layout), str(recording), "-o", str(merged)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise RuntimeError(f"{recording}: {done.stderr.strip().splitlines()[-1]}")
        return merged.read_bytes()


def script_of(name: str, recording: bytes) -> str:
    """A recording as a script: a page that is opened from a file may load scripts and nothing else."""
    return f'arrived("{name}","{packed(recording)}")\n'


def script_of_run(results: Results, run: str) -> str:
    """A run's recording, with its layout, as a script."""
    return script_of(recording_id(run), with_layout(results, run))


def packed(content: bytes) -> str:
    """Compressed and in base64; the same for the same content."""
    return base64.b64encode(gzip.compress(content, 6, mtime=0)).decode("ascii")
