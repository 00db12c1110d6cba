"""The documentation's notebook: it runs on a study, and says what is stored in it."""

import importlib.util
import re
from types import SimpleNamespace

import pytest

from tests import notebook as own
from tests.paths import ROOT
from upswing.analysis.aggregate import write_tables
from upswing.runs.study_file import canonical, parse_study, write_study
from upswing.runs.train import train
from upswing.study.config import load, validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix

# One kernel serves the tests of this file that need no results: on one worker.

STUDY = {
    "seeds": {"first": 10_000, "count": 3},
    "tasks": {"full-control": {"kind": "full-control", "steps": 8_000}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["full-control"], "architectures": ["table"], "alphas": [0.1, 0.01]}],
}
"""Short runs of the cells that the notebook looks at."""


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    """The notebook, run on a small study."""
    folder = tmp_path_factory.mktemp("small")
    study = validated({"study": STUDY})
    write_study(canonical(study), folder)
    for spec in Matrix(study).cells.values():
        train(spec, folder)
    write_tables(folder, Matrix(study))
    return own.executed(folder)


def pairs(fresh):
    stored = own.read()
    assert [cell.source for cell in stored.cells] == [cell.source for cell in fresh.cells]
    return list(zip(own.code_cells(stored), own.code_cells(fresh), strict=True))


def test_every_cell_runs_and_says_something(small):
    for stored, fresh in pairs(small):
        assert own.texts(fresh), fresh.source
        # The same kinds of outputs: text, tables, pictures.
        assert [sorted(one.get("data", {})) for one in fresh.outputs] == [
            sorted(one.get("data", {})) for one in stored.outputs
        ]
        assert all(one.get("name") != "stderr" for one in fresh.outputs)


def test_what_depends_on_no_results_is_as_it_is_stored(small):
    compared = [
        (own.texts(stored), own.texts(fresh))
        for stored, fresh in pairs(small)
        if own.OWN in stored.metadata.get("tags", [])
    ]
    assert len(compared) == 3
    for stored, fresh in compared:
        assert stored == fresh


def test_it_says_of_the_small_study_what_is_true_of_it(small):
    said = "\n".join(text for _, fresh in pairs(small) for text in own.texts(fresh))
    assert "2 cells, 6 runs" in said
    assert re.search(r"\d+% of 3 runs stand at the end", said)
    assert "learned again: bit for bit the same" in said


@pytest.mark.heavy
def test_its_outputs_are_those_of_the_study():
    """All of them, where the study of the thesis has run: `make notebook` renews them."""
    results = ROOT / "results"
    try:
        asked = load(ROOT / "config/config.yaml")
        found = parse_study((results / "study.json").read_text("utf-8"), "study")
    except (OSError, BadInput):
        pytest.skip("the study of the thesis has not run here: make reproduce")
    if canonical(found) != canonical(asked):
        pytest.skip("results are not of config/config.yaml")
    if not (results / "tables/cells.parquet").is_file():
        pytest.skip("the study of the thesis is not finished")
    fresh = own.executed(own.beside(results))
    for stored, again in pairs(fresh):
        assert own.texts(stored) == own.texts(again), stored.source


def test_the_page_shows_what_is_stored():
    place = ROOT / "docs/notebook_page.py"
    hook = importlib.util.module_from_spec(importlib.util.spec_from_file_location("hook", place))
    hook.__spec__.loader.exec_module(hook)
    page = SimpleNamespace(file=SimpleNamespace(abs_src_path=str(ROOT / "docs/notebook.md")))
    shown = hook.on_page_markdown("before\n\n<!-- cells of notebook.ipynb -->\n\nafter", page)
    assert shown.startswith("before\n\n# A study in a notebook")
    assert shown.endswith("\n\nafter")
    cells = own.code_cells(own.read())
    assert shown.count("```python\n") == len(cells)
    pictures = [one for cell in cells for one in cell.outputs if "image/png" in one.get("data", {})]
    assert shown.count('src="data:image/png;base64,') == len(pictures) == 3
    assert "style>" not in shown
    for cell in cells:
        for output in cell.outputs:
            if "text/html" not in output.get("data", {}) and "image/png" not in output.get(
                "data", {}
            ):
                assert (output.get("text") or output.data["text/plain"]).strip() in shown


def test_what_is_stored_is_small_and_names_no_machine():
    text = own.NOTEBOOK.read_text("utf-8")
    assert len(text) < 200_000
    assert not re.search(
        r"/(home|root|tmp|work|usr|Users)/", re.sub(r'"image/png": ".*"', "", text)
    )
    notebook = own.read()
    assert set(notebook.metadata) == {"kernelspec"}
    assert [cell.execution_count for cell in own.code_cells(notebook)] == [
        number + 1 for number in range(len(own.code_cells(notebook)))
    ]
