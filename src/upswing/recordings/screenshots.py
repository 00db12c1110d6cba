"""Pictures of the recordings for the documentation, taken in a viewer without a screen."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from PIL import Image

from upswing.recordings.catalog import catalog
from upswing.recordings.ports import LOOPBACK, free_port, listens
from upswing.recordings.processes import running
from upswing.recordings.program import RERUN
from upswing.runs.files.atomic import written
from upswing.runs.recording.layout import run_layout
from upswing.runs.results import Results
from upswing.study.ids import cell_of, recording_of
from upswing.study.paths import comparison

if TYPE_CHECKING:
    from rerun.experimental import ViewerClient

WIDTH = 1440
"""Of a picture [pixels]."""

COLOURS = 256
PATIENCE = 20.0
"""Time limit for a viewer to load what it shows [s]."""


def take_screenshots(results: Results, folder: Path, run: str, task: str) -> None:
    """Write ``run.png``, ``comparison.png`` and ``catalog.png`` into ``folder``.

    Args:
        results: whose recordings are shown.
        folder: where the pictures go.
        run: the id of the run that is shown.
        task: the task whose runs are compared.
    """
    cell = results.cells[cell_of(run)]
    with (
        TemporaryDirectory() as temporary,
        # A catalog waits for its viewers to go: the viewer ends first.
        catalog(results, results.runs, free_port()) as served,
        headless_viewer() as viewer,
    ):
        layout = Path(temporary) / "layout.rbl"
        run_layout(cell.task).save(f"upswing-{cell.task.name}", layout)
        viewer.open(str(layout), navigate=False)
        viewer.open(str(results.folder / recording_of(run)))
        _picture(viewer, folder / "run.png", "frame", 1_100)
        viewer.open(str(results.folder / comparison(f"task-{task}")))
        _picture(viewer, folder / "comparison.png", "step", cell.task.steps // 2)
        viewer.open(served.datasets[task])
        _picture(viewer, folder / "catalog.png")


@contextmanager
def headless_viewer() -> Iterator["ViewerClient"]:
    """A viewer without a screen, of 1920 × 1080 pixels; it needs a Vulkan driver, Mesa's will do."""
    from rerun.experimental import ViewerClient

    port = free_port()
    command = [str(RERUN), "--headless", "--hide-welcome-screen", "--bind", LOOPBACK]
    with running([*command, "--port", str(port)]) as process:
        until = time.monotonic() + PATIENCE
        while not listens(port):
            if process.poll() is not None or time.monotonic() > until:
                raise RuntimeError("the viewer did not start; it needs a Vulkan driver")
            time.sleep(0.05)
        yield ViewerClient.connect(f"rerun+http://{LOOPBACK}:{port}/proxy")


def wait_until_loaded(viewer: "ViewerClient") -> None:
    """Wait until a viewer has loaded what it shows; ``TimeoutError`` if it takes too long."""
    until = time.monotonic() + PATIENCE
    while viewer.get_state().loading:
        if time.monotonic() > until:
            raise TimeoutError(f"the viewer was still loading after {PATIENCE:g} s")
        time.sleep(0.1)


def _picture(
    viewer: "ViewerClient", path: Path, timeline: str | None = None, at: int | None = None
) -> None:
    wait_until_loaded(viewer)
    if timeline is not None and at is not None:
        viewer.set_time(timeline, sequence=at, play_state="paused")
    time.sleep(1.5)  # for what is drawn in the background
    picture = Image.open(BytesIO(viewer.take_screenshot(max_size=WIDTH))).convert("RGB")
    with written(path) as beside:
        picture.quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE).save(
            beside, format="PNG", optimize=True
        )
