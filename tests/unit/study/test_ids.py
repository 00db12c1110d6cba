"""Ids and paths: what is built is what is taken apart, whatever a task is called."""

import re
from pathlib import Path

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.paths import ROOT
from upswing.recordings.run_filter import _by_id
from upswing.study.errors import BadInput
from upswing.study.ids import (
    RUN_FILES,
    CellId,
    cell_id,
    cell_of,
    file_of,
    named_by,
    recording_id,
    recording_of,
    run_id,
    run_of,
    seed_of,
)

names = st.one_of(
    st.sampled_from(["runs", "my-runs", "alpha-1", "seed-3"]),
    st.from_regex(r"[a-z][a-z0-9]*(-[a-z0-9]+){0,2}", fullmatch=True),
)
alphas = st.one_of(st.none(), st.sampled_from([1.0, 0.75, 0.001, 1e-9]))


@given(task=names, architecture=names, alpha=alphas, seed=st.integers(0, 2**32 - 1))
def test_an_id_is_taken_apart_into_what_it_was_built_of(task, architecture, alpha, seed):
    cell = cell_id(task, architecture, alpha)
    run = run_id(cell, seed)
    parts = CellId.parse(cell)
    assert (parts.task, parts.architecture) == (task, architecture)
    assert cell_of(run) == cell
    assert seed_of(run) == seed
    assert run_of(recording_of(run)) == run_of(run) == run
    assert re.fullmatch(r"[A-Za-z0-9_-]+", recording_id(run))
    for kind in RUN_FILES:
        assert file_of(run, kind) == f"runs/{run}.{kind}"


@pytest.mark.parametrize(
    ("cell", "label"),
    [("a/table/alpha-0.75", "table, α = 0.75"), ("a/idle/alpha-none", "idle")],
)
def test_a_cells_label_leaves_out_the_task_and_what_a_control_has_not(cell, label):
    assert CellId.parse(cell).label == label


@pytest.mark.parametrize("task", ["balancing", "runs", "my-runs"])
def test_a_run_is_found_by_its_id_its_cell_its_task_and_its_path(task):
    run = f"{task}/table/alpha-1/seed-0"
    runs = pd.DataFrame({"run": [run, "other/table/alpha-1/seed-0"]})
    for word in (run, f"{task}/table/alpha-1", task, f"runs/{run}.rrd", f"some/runs/{run}.rrd"):
        assert list(_by_id(runs, word)["run"]) == [run], word
    with pytest.raises(BadInput, match="no such run"):
        _by_id(runs, f"elsewhere/{task}")


def test_no_other_file_builds_or_takes_apart_a_path_of_a_run():
    by_hand = re.compile(r'rsplit\("/|\.split\("/|[f/ ]"runs/|/ "runs" /|removesuffix\("\.rrd"\)')
    paths = [*(ROOT / "src").rglob("*.py"), ROOT / "Snakefile", *(ROOT / "workflow/rules").glob("*.smk")]  # fmt: skip
    found = {
        path.relative_to(ROOT): line
        for path in paths
        if path.name != "ids.py"
        for line in path.read_text("utf-8").splitlines()
        if by_hand.search(line)
    }
    assert set(found) <= {Path("src/upswing/recordings/run_filter.py")}, found  # what a user writes


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("balancing/table/alpha-0.5/seed-3", ("balancing/table/alpha-0.5", 3)),
        ("balancing/table/alpha-0.5", ("balancing/table/alpha-0.5", None)),
        ("balancing/idle/alpha-none/seed-0/", ("balancing/idle/alpha-none", 0)),
        ("results/runs/balancing/table/alpha-1/seed-12.weights.safetensors", ("balancing/table/alpha-1", 12)),
        ("/a b/runs/balancing/table/alpha-1/seed-12.rrd", ("balancing/table/alpha-1", 12)),
        ("balancing/table", None),
        ("balancing/table/alpha-x/seed-1", None),
        ("balancing/table/alpha-1/seed-", None),
        ("", None),
    ],
)  # fmt: skip
def test_what_an_id_or_a_path_names(text, expected):
    assert named_by(text) == expected
