"""A catalog of recordings on this machine alone, and a viewer for it: ``make browse``."""

import os
import re
import signal
import socket
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple
from urllib.parse import quote

import pandas as pd

from upswing.recordings.ports import LOOPBACK, check_free
from upswing.recordings.processes import running
from upswing.recordings.program import RERUN
from upswing.recordings.studies import Chosen
from upswing.runs.results import Results
from upswing.study.errors import BadInput

PORT, WEB_PORT = 9871, 9872
"""Where the catalog and the web viewer are served, where nothing else is said."""


AT_A_TIME = 250
"""Number of recordings that are registered between two words about it."""

Say = Callable[[str], None]
"""Takes a line for the reader."""


class Catalog(NamedTuple):
    """A catalog that is being served."""

    url: str  # the catalog; the one dataset, or the one run, where there is only one
    datasets: dict[str, str]  # the address of each table, by the name of its dataset
    runs: int


def silent(_: str) -> None:
    """Say nothing."""


@contextmanager
def catalog(results: Results, runs: pd.DataFrame, port: int) -> Iterator[Catalog]:
    """Serve the recordings of ``runs`` of one study, as ``catalog_of`` does."""
    with catalog_of([Chosen(results.folder.name, results, runs)], port) as served:
        yield served


@contextmanager
def catalog_of(chosen: Sequence[Chosen], port: int, say: Say = silent) -> Iterator[Catalog]:
    """Serve recordings on 127.0.0.1: a dataset for each task of each study, with its layout.

    A dataset has the name of its task; of several studies, that of its study before it.

    Raises:
        BadInput: the port is in use, or recordings are missing.
    """
    import rerun as rr

    from upswing.runs.recording.layout import run_layout, table_layout

    check_free(port)
    groups = {
        _dataset(one.study, str(task), len(chosen) > 1): (one.results, str(task), rows)
        for one in chosen
        for task, rows in one.runs.groupby("task", sort=False)
    }
    paths = {
        name: [(results.folder / path).resolve() for path in rows["recording"]]
        for name, (results, _, rows) in groups.items()
    }
    if missing := [path for group in paths.values() for path in group if not path.is_file()]:
        raise BadInput([f"{missing[0]}: missing ({len(missing)} in all); run the study again"])
    total = sum(map(len, paths.values()))
    with TemporaryDirectory() as folder, rr.server.Server(host=LOOPBACK, port=port) as server:
        url = str(server.url())
        client = server.client()
        datasets, done = {}, 0
        for number, (name, (results, task, _)) in enumerate(groups.items()):
            dataset = client.create_dataset(name)
            for first in range(0, len(paths[name]), AT_A_TIME):
                part = paths[name][first : first + AT_A_TIME]
                dataset.register([path.as_uri() for path in part]).wait()
                done += len(part)
                if total > AT_A_TIME:
                    say(f"  {done:,} of {total:,} recordings registered ({name})")
            of_task = next(cell.task for cell in results.cells.values() if cell.task.name == task)
            layout, table = (Path(folder, f"{number}-{what}.rbl") for what in ("run", "table"))
            run_layout(of_task).save(f"upswing-{task}", layout)
            dataset.register_blueprint(layout.as_uri())
            table_layout(of_task).save(f"upswing-{task}-table", table)
            dataset.register_blueprint(table.as_uri(), segment_table=True)
            datasets[name] = f"{server.url()}/entry/{dataset.id}"
            if total == 1:
                url = dataset.segment_url(dataset.segment_ids()[0])
            elif len(groups) == 1:
                url = datasets[name]
        yield Catalog(url, datasets, total)


def _dataset(study: str, task: str, several: bool) -> str:
    """The name of a dataset; the server takes letters, digits and few others."""
    return re.sub(r"[^\w :.-]", "-", f"{study}: {task}") if several else task


def check_display(ports: Sequence[int]) -> None:
    """``BadInput`` if no window can be opened; it says how to see a page, which needs ``ports``."""
    if not has_display():
        words = (
            "there is no display here; `upswing browse --web` (or `make browse WEB=1`) serves a page "
            f"instead. Over ssh, say on the computer before you `{tunnel(ports)}` and open the "
            "address of the page there"
        )
        raise BadInput([words])


def tunnel(ports: Sequence[int]) -> str:
    """The command that brings ports of this machine to the one before which somebody sits."""
    ways = " ".join(f"-L {port}:{LOOPBACK}:{port}" for port in ports)
    return f"ssh -N {ways} {socket.gethostname()}"


def show(catalog: Catalog, web: bool, web_port: int) -> None:
    """Open a viewer on ``catalog`` and wait until it is closed, or Ctrl-C."""
    if web:
        check_free(web_port)
        command = [str(RERUN), "--serve-web", "--bind", LOOPBACK]
        command += ["--web-viewer-port", str(web_port), catalog.url]
        page = f"http://{LOOPBACK}:{web_port}/?url={quote(catalog.url, safe='')}"
        print(f"{catalog.runs:,} runs at {page}\nCtrl-C ends it.", flush=True)
    else:
        check_display([PORT, WEB_PORT])
        command = [str(RERUN), catalog.url]
        print(
            f"{catalog.runs:,} runs at {catalog.url}\nClose the viewer or press Ctrl-C to end it."
        )
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
