"""A catalog of recordings on this machine alone, and a viewer for it: ``make browse``."""

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple
from urllib.parse import quote

import pandas as pd

from upswing.recordings.ports import LOOPBACK, check_free
from upswing.recordings.processes import running
from upswing.recordings.program import RERUN
from upswing.runs.results import Results
from upswing.study.errors import BadInput

PORT, WEB_PORT = 9871, 9872
"""Where the catalog and the web viewer are served, where nothing else is said."""


class Catalog(NamedTuple):
    """A catalog that is being served."""

    url: str  # the catalog; the one task, or the one run, where there is only one
    datasets: dict[str, str]  # the address of each task's table
    runs: int


@contextmanager
def catalog(results: Results, runs: pd.DataFrame, port: int) -> Iterator[Catalog]:
    """Serve the recordings of ``runs`` on 127.0.0.1, a dataset for each task, with its layout."""
    import rerun as rr

    from upswing.runs.recording.layout import run_layout, table_layout

    check_free(port)
    paths = {
        str(task): [results.folder / recording for recording in group["recording"]]
        for task, group in runs.groupby("task", sort=False)
    }
    missing = [path for group in paths.values() for path in group if not path.is_file()]
    if missing:
        raise BadInput([f"{missing[0]}: missing ({len(missing)} in all); run the study again"])
    tasks = {cell.task.name: cell.task for cell in results.cells.values()}
    with (
        TemporaryDirectory() as folder,
        rr.server.Server(host=LOOPBACK, port=port, datasets=dict(paths)) as server,
    ):
        url = str(server.url())
        client = server.client()
        datasets = {}
        for task in paths:
            layout = Path(folder) / f"{task}.rbl"
            run_layout(tasks[task]).save(f"upswing-{task}", layout)
            dataset = client.get_dataset(task)
            dataset.register_blueprint(layout.as_uri())
            table = Path(folder) / f"{task}-table.rbl"
            table_layout(tasks[task]).save(f"upswing-{task}-table", table)
            dataset.register_blueprint(table.as_uri(), segment_table=True)
            datasets[task] = f"{server.url()}/entry/{dataset.id}"
            if len(runs) == 1:
                url = dataset.segment_url(dataset.segment_ids()[0])
            elif len(paths) == 1:
                url = datasets[task]
        yield Catalog(url, datasets, len(runs))


def show(catalog: Catalog, web: bool, web_port: int) -> None:
    """Open a viewer on ``catalog`` and wait until it is closed, or Ctrl-C."""
    if web:
        check_free(web_port)
        command = [str(RERUN), "--serve-web", "--bind", LOOPBACK]
        command += ["--web-viewer-port", str(web_port), catalog.url]
        page = f"http://{LOOPBACK}:{web_port}/?url={quote(catalog.url, safe='')}"
        print(f"{catalog.runs} runs at {page}\nCtrl-C ends it.", flush=True)
    else:
        if not has_display():
            raise BadInput(
                ["there is no display here; `upswing browse --web` serves a page instead"]
            )
        command = [str(RERUN), catalog.url]
        print(f"{catalog.runs} runs at {catalog.url}\nClose the viewer or press Ctrl-C to end it.")
    # However it is asked to end, it ends as by Ctrl-C; a shell may have switched that off.
    for sign in (signal.SIGINT, signal.SIGTERM):
        signal.signal(sign, signal.default_int_handler)
    with running(command) as process:
        try:
            process.wait()
        except KeyboardInterrupt:
            print()


def has_display() -> bool:
    """Whether a window can be opened."""
    if sys.platform != "linux":
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
