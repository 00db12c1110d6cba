"""Running the documentation's notebook: ``make notebook`` stores what it says, a test compares.

The notebook is a guest in a folder of results: its first cell opens ``../results``, beside ``docs``.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import nbformat
from nbclient import NotebookClient
from traitlets.config import Config

from tests.paths import ROOT

NOTEBOOK = ROOT / "docs/notebook.ipynb"
OPENS = 'upswing.open("../results")'
OWN = "own"
"""The tag of a cell whose output depends on no results: it is the same in every study."""

PATIENCE = 300
"""A cell has so long [s]; compiling what is needed for the first time is most of it."""


def read() -> Any:
    """The notebook as it is stored."""
    return nbformat.read(NOTEBOOK, as_version=4)


def executed(results: Path) -> Any:
    """The notebook, run on the folder ``results`` by a kernel of its own, which then ends.

    Raises:
        nbclient.exceptions.CellExecutionError: a cell failed.
    """
    notebook = read()
    for cell in code_cells(notebook):
        cell.source = cell.source.replace(OPENS, f"upswing.open({str(results)!r})")
    with _no_traces() as folder:
        client = NotebookClient(
            notebook,
            timeout=PATIENCE,
            kernel_name="python3",
            config=Config({"ConnectionFileMixin": {"transport": "ipc", "ip": f"{folder}/kernel"}}),
            record_timing=False,
            resources={"metadata": {"path": str(NOTEBOOK.parent)}},
        )
        client.execute()
    for cell in code_cells(notebook):
        cell.source = cell.source.replace(f"upswing.open({str(results)!r})", OPENS)
    # Of the interpreter that happened to run it, nothing is kept.
    notebook.metadata = {"kernelspec": dict(notebook.metadata["kernelspec"])}
    return notebook


def code_cells(notebook: Any) -> list[Any]:
    """The cells of code, in order."""
    return [cell for cell in notebook.cells if cell.cell_type == "code"]


def texts(cell: Any) -> list[str]:
    """What a cell says in words: its outputs but for pictures."""
    found = []
    for output in cell.outputs:
        data = output.get("data", {})
        if output.output_type == "stream":
            found.append(output.text)
        elif "image/png" not in data:
            found += [data[kind] for kind in ("text/plain", "text/html") if kind in data]
        else:
            found.append("a picture")
    return found


@contextmanager
def _no_traces() -> Iterator[str]:
    """IPython and Jupyter keep a history, and sockets: in a folder that goes. No port is opened."""
    with TemporaryDirectory() as folder:
        own = {"IPYTHONDIR": f"{folder}/ipython", "JUPYTER_RUNTIME_DIR": f"{folder}/runtime"}
        before = {key: os.environ.get(key) for key in own}
        os.environ.update(own)
        try:
            yield folder
        finally:
            for key, value in before.items():
                if value is None:
                    del os.environ[key]
                else:
                    os.environ[key] = value


def beside(results: Path) -> Path:
    """A folder of results as the notebook names it: from where it stands."""
    return Path(os.path.relpath(results, NOTEBOOK.parent))


def main(folder: str) -> None:
    """Run the notebook on a folder of results, named as from the checkout, and store its outputs."""
    notebook = executed(beside(ROOT / folder))
    nbformat.write(notebook, NOTEBOOK)
    print(f"{NOTEBOOK.relative_to(ROOT)}: {NOTEBOOK.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main(*sys.argv[1:])
