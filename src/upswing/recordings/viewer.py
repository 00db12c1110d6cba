"""A viewer of chosen recordings that needs no server: ``report/viewer/``, opened from plain files.

The viewer is the one that the installed Rerun serves, so it reads what this Rerun has written. What
starts it stands in ``report/viewer.html``; that interface is Rerun's own and may change with a version,
which is why a test opens the page in a browser.
"""

import shutil
import subprocess
import time
from pathlib import Path
from urllib.error import URLError
from urllib.request import urlopen

from upswing.recordings.browse import free_port
from upswing.recordings.comparison import claim_names, task_names
from upswing.recordings.lending import LOOPBACK
from upswing.recordings.names import VIEWER, recording_id
from upswing.recordings.singly import chosen_runs, packed, script_of, script_of_run
from upswing.runs import Results
from upswing.store.ledger import seal

FOLDER = "report/viewer"
PATIENCE = 20.0
"""The viewer's own server has so long to start [s]."""


def write_viewer(results: Results, templates: Path) -> list[str]:
    """Write the page, the viewer and the chosen recordings; returns the recordings' names.

    Args:
        results: whose recordings are shown; figures, verdicts and comparisons must be there.
        templates: the folder with ``viewer.html``.
    """
    folder = results.folder / FOLDER
    beside = folder.with_name(f"{folder.name}.part")
    shutil.rmtree(beside, ignore_errors=True)
    (beside / "recordings").mkdir(parents=True)
    shutil.copyfile(templates / "viewer.html", beside / "index.html")
    code, engine = _viewer_files()
    (beside / "viewer.js").write_bytes(code)
    (beside / "engine.js").write_text(f'arrived("engine","{packed(engine)}")\n', "ascii")
    names = []
    for kind, one_of in (("task", task_names(results)), ("claim", claim_names(results))):
        for each in one_of:
            names.append(f"{kind}-{each}")
            recording = results.folder / "recordings" / f"{names[-1]}.rrd"
            _write_script(beside, names[-1], script_of(names[-1], recording.read_bytes()))
    for run in chosen_runs(results):
        names.append(recording_id(run))
        _write_script(beside, names[-1], script_of_run(results, run))
    shutil.rmtree(folder, ignore_errors=True)
    beside.rename(folder)
    seal(results.folder, "viewer", [folder])
    return names


def _write_script(folder: Path, name: str, script: str) -> None:
    (folder / "recordings" / f"{name}.js").write_text(script, "ascii")


def _viewer_files() -> tuple[bytes, bytes]:
    """The script and the WebAssembly of the installed viewer, which only its server hands out."""
    port, other = free_port(), free_port()
    command = [str(VIEWER), "--serve-web", "--bind", LOOPBACK, "--port", str(other)]
    with subprocess.Popen(
        [*command, "--web-viewer-port", str(port)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as server:
        try:
            code = _fetched(f"http://{LOOPBACK}:{port}/re_viewer.js")
            return code, _fetched(f"http://{LOOPBACK}:{port}/re_viewer_bg.wasm")
        finally:
            server.terminate()


def _fetched(address: str) -> bytes:
    until = time.monotonic() + PATIENCE
    while True:
        try:
            with urlopen(address, timeout=PATIENCE) as answer:  # noqa: S310  our own server
                content: bytes = answer.read()
                return content
        except URLError:
            if time.monotonic() > until:
                raise RuntimeError(f"{address}: the viewer did not start") from None
            time.sleep(0.1)
