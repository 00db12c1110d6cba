"""A catalog of recordings on this machine alone, and a viewer for it: ``make browse``."""

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple
from urllib.parse import quote

import pandas as pd

from upswing.recordings.asked_to_end import ended_by_signals, wait_for
from upswing.recordings.fence import fenced
from upswing.recordings.ports import LOOPBACK, check_free, free_port
from upswing.recordings.processes import Process, running
from upswing.recordings.program import RERUN
from upswing.recordings.starting import wait_until_listening
from upswing.recordings.studies import Chosen
from upswing.runs.results import Results
from upswing.study.errors import BadInput

AT_A_TIME = 250
"""Number of recordings that are registered between two words about it."""

Say = Callable[[str], None]
"""Takes a line for the reader."""


class Catalog(NamedTuple):
    """A catalog that is being served."""

    url: str  # the catalog; the one dataset, or the one run, where there is only one
    datasets: dict[str, str]  # the address of each table, by the name of its dataset
    runs: int
    port: int  # on which it answers


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
        yield Catalog(url, datasets, total, port)


def _dataset(study: str, task: str, several: bool) -> str:
    """The name of a dataset; the server takes letters, digits and few others."""
    return re.sub(r"[^\w :.-]", "-", f"{study}: {task}") if several else task


def show(catalog: Catalog, web: bool, web_port: int) -> None:
    """Open a viewer on ``catalog`` and wait until it is closed, or Ctrl-C."""
    with ended_by_signals(), _page(catalog, web_port) if web else _window(catalog) as process:
        wait_for(process)


@contextmanager
def _window(catalog: Catalog) -> Iterator[Process]:
    print(f"{catalog.runs:,} runs at {catalog.url}\nClose the viewer or press Ctrl-C to end it.")
    with running([str(RERUN), catalog.url]) as process:
        yield process


@contextmanager
def _page(catalog: Catalog, port: int) -> Iterator[Process]:
    """The viewer's page, behind a fence."""
    check_free(port)
    inner = free_port()
    command = [str(RERUN), "--serve-web", "--bind", LOOPBACK, "--port", str(free_port())]
    command += ["--web-viewer-port", str(inner), catalog.url]
    address = f"http://{LOOPBACK}:{port}/?url={quote(catalog.url, safe='')}"
    with running(command) as process, fenced(port, inner, catalog.port):
        wait_until_listening(process, inner)
        print(f"{catalog.runs:,} runs at {address}\nCtrl-C ends it.", flush=True)
        yield process
