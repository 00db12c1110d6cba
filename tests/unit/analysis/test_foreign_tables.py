"""Valid Parquet of another origin in the place of any table: one clear line that names the file."""

import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.unit.analysis.small_sweeps import STUDY as SWEPT
from tests.unit.analysis.small_sweeps import SWEEPS
from upswing.analysis.beyond_tables import OF_A_CHANGE, OF_THE_CHOSEN
from upswing.analysis.robustness.tables import (
    OF_A_CAUSE,
    OF_A_READING,
    OF_A_SELECTION,
    OF_A_SUMMARY,
)
from upswing.cli.main import main
from upswing.optimal.tables import OF_THE_BOUND, OF_THE_MAPS
from upswing.report.cost import OF_A_BENCHMARK, OF_AN_EDIT, OF_GROWTH
from upswing.runs.files.tables import JUDGED
from upswing.runs.files.typed_table import read_table
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.runs.sweep import OF_A_SWEPT_RUN, path_of
from upswing.study.claim_parts import Verdict
from upswing.study.errors import BadInput
from upswing.study.paths import (
    BENCHMARK,
    BOUND,
    CELLS,
    CHANGES,
    CHOSEN,
    DECISIVE,
    EDITS,
    EVIDENCE,
    GROWTH,
    MAPS,
    READINGS,
    ROBUST,
    RUNS,
    SELECTION,
    TILES,
    VERDICTS,
)
from upswing.study.sweeps import groups, load_sweeps

pytestmark = pytest.mark.heavy  # it tries every kind of foreign table in every place

RUN = "runs/balancing/table/alpha-0.1/seed-1"
WINDOWS, TRAJECTORY = f"{RUN}.windows.parquet", f"{RUN}.trajectory.parquet"
EXAMPLES = {"text": "a", "number": 0.5, "whole": 1, "truth": True, "texts": ["a"]}
KINDS = ["other columns", "no rows", "wrong types", "random", "swapped"]


@pytest.fixture
def folder(results, tmp_path):
    copy = tmp_path / "results"
    added = ("report", "figures", "recordings", "weights.safetensors")
    shutil.copytree(results.folder, copy, ignore=shutil.ignore_patterns(*added))
    return copy


def of_columns(columns):
    """Two rows of a table with these columns."""
    row = {name: EXAMPLES[kind.removesuffix("?")] for name, kind in columns.items()}
    return pd.DataFrame([row, row])


def foreign(kind, frame):
    if kind == "other columns":
        return pd.DataFrame({"x": [1, 2], "y": ["a", "b"]})
    if kind == "no rows":
        return frame.iloc[:0]
    if kind == "swapped":  # every column is there, and none holds what it should
        flags = [pd.api.types.is_numeric_dtype(frame[name]) for name in frame]
        return pd.DataFrame(
            {n: (["a"] if flag else [b"a"]) * 2 for n, flag in zip(frame, flags, strict=True)}
        )
    if kind == "wrong types":
        return frame.map(lambda value: [str(value)])
    random = np.random.default_rng(0).normal(size=(5, 3))
    return pd.DataFrame(random, columns=["run", "claim", "cell"])


def refused(arguments, path, capsys):
    """The line in which a subcommand refuses a table."""
    capsys.readouterr()
    assert main([str(argument) for argument in arguments]) == 2
    said = capsys.readouterr().err
    assert said.startswith("upswing: 1 problem:\n"), said
    lines = said.strip().splitlines()
    assert len(lines) == 2, said
    assert str(path) in lines[1]
    assert len(lines[1]) < 600
    return lines[1]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("table", "subcommands"),
    [
        (RUNS, [["report"], ["browse", "--print", "--results"], ["compare"]]),
        (CELLS, [["report"]]),
        (VERDICTS, [["report"], ["browse", "claim=C1", "--print", "--results"], ["compare"], ["readme"]]),
        (EVIDENCE, [["report"], ["compare"]]),
        (TRAJECTORY, [["comparisons"]]),
        (WINDOWS, [["tables"], ["comparisons"], ["figure", "overview"], ["verdicts"]]),
    ],
)  # fmt: skip
def test_a_foreign_table_of_a_study_is_refused(folder, table, subcommands, kind, capsys, results):
    path = folder / table
    if table == TRAJECTORY:  # of a run that a claim shows
        recordings = pd.read_parquet(folder / VERDICTS)["recordings"]
        shown = next(paths[0] for paths in recordings if len(paths))
        path = folder / shown.replace(".rrd", ".trajectory.parquet")
    foreign(kind, pd.read_parquet(path)).to_parquet(path)
    for subcommand in subcommands:
        if subcommand == ["compare"]:
            refused(["compare", results.folder, folder], path, capsys)
        refused(
            [*subcommand, folder, *([results.folder] if subcommand == ["compare"] else [])],
            path,
            capsys,
        )


OPTIONAL = {
    BOUND: OF_THE_BOUND, MAPS: OF_THE_MAPS, CHANGES: OF_A_CHANGE, CHOSEN: OF_THE_CHOSEN,
    SELECTION: OF_A_SELECTION, READINGS: OF_A_READING, DECISIVE: OF_A_CAUSE, ROBUST: OF_A_SUMMARY,
    BENCHMARK: OF_A_BENCHMARK, GROWTH: OF_GROWTH, EDITS: OF_AN_EDIT,
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("table", OPTIONAL)
def test_a_foreign_table_of_what_need_not_be_there_is_refused(folder, table, kind, capsys):
    if table == DECISIVE and kind == "no rows":
        return  # it may be that nothing decides any claim
    for other in {BOUND, CHANGES, READINGS, DECISIVE, ROBUST} - {table}:
        of_columns(OPTIONAL[other]).to_parquet(folder / other)
    foreign(kind, of_columns(OPTIONAL[table])).to_parquet(folder / table)
    path = folder / table
    if table == MAPS:
        refused(["figure", "bound", folder], path, capsys)
    else:
        refused(["report", folder], path, capsys)
    if table == BOUND:
        refused(["changes", folder], path, capsys)
    if table == CHANGES:
        refused(["figure", "changes", folder], path, capsys)


def test_tables_of_the_right_form_without_what_is_needed_are_refused(folder, capsys):
    for table in (BOUND, CHANGES):
        of_columns(OPTIONAL[table]).to_parquet(folder / table)
    refused(["changes", folder], folder / BOUND, capsys)
    refused(["report", folder], folder, capsys)
    of_columns({**OF_THE_MAPS, "action_0.7": "whole", "action_0.97": "whole"}).to_parquet(
        folder / MAPS
    )
    refused(["figure", "bound", folder], folder / MAPS, capsys)


@pytest.mark.parametrize("kind", [*KINDS, "another sweep's"])
def test_a_foreign_table_of_a_sweep_is_refused(tmp_path, kind, capsys):
    write_study(canonical(SWEPT), tmp_path)
    file = tmp_path / "readings.yaml"
    file.write_text(SWEEPS, "utf-8")
    whole = of_columns(OF_A_SWEPT_RUN)
    paths = [
        path_of(tmp_path, name, group.name)
        for name, sweep in load_sweeps(file, SWEPT).items()
        for group in groups(sweep, SWEPT)
    ]
    for path in paths:
        path.parent.mkdir(parents=True, exist_ok=True)
        (whole if kind == "another sweep's" else foreign(kind, whole)).to_parquet(path)
    refused(["readings", "--sweeps", file, tmp_path], paths[0], capsys)


@pytest.mark.parametrize("kind", KINDS)
def test_a_foreign_table_of_the_tiles_is_refused(tmp_path, kind):
    path = tmp_path / TILES
    path.parent.mkdir()
    foreign(kind, of_columns({"angle": "number", "success": "truth"})).to_parquet(path)
    with pytest.raises(BadInput) as caught:
        _ = Results(tmp_path).tile_policy
    (line,) = caught.value.problems
    assert line.startswith(f"{path}: ")
    assert line.endswith(f"`upswing tiles {tmp_path}` makes it")


@pytest.mark.parametrize("table", [RUNS, CELLS, VERDICTS, EVIDENCE])
def test_rows_of_another_study_or_twice_the_same_are_refused(folder, table, capsys):
    path, frame = folder / table, pd.read_parquet(folder / table)
    pd.concat([frame, frame.iloc[:1]]).to_parquet(path)
    assert "is there twice" in refused(["report", folder], path, capsys)
    key = {RUNS: "run", CELLS: "cell"}.get(table, "verdict")
    frame.loc[0, key] = "balancing/table/alpha-7/seed-0"
    frame.to_parquet(path)
    refused(["report", folder], path, capsys)


def test_a_recording_elsewhere_is_refused(folder, capsys):
    frame = pd.read_parquet(folder / RUNS)
    frame["recording"] = "../../secret.rrd"
    frame.to_parquet(folder / RUNS)
    said = refused(["browse", "--print", "--results", folder], folder / RUNS, capsys)
    assert "is not its recording" in said


def test_empty_tables_are_not_the_same(folder, tmp_path, capsys):
    """Two folders whose tables have no rows."""
    for table in (RUNS, VERDICTS, EVIDENCE):
        pd.read_parquet(folder / table).iloc[:0].to_parquet(folder / table)
    other = tmp_path / "other"
    shutil.copytree(folder, other)
    assert main(["compare", str(folder), str(other)]) == 2
    said = capsys.readouterr().err
    assert said.startswith("upswing: 2 problems:\n")
    for one in (folder, other):
        assert f"{one / VERDICTS}: is no such table: it has no rows" in said


def test_the_verdicts_that_are_read_are_those_that_are_given():
    assert set(JUDGED) == set(Verdict.__args__)


cells = st.one_of(
    st.none(), st.booleans(), st.integers(-9, 9), st.floats(), st.text(max_size=3), st.binary(max_size=3),
    st.lists(st.text(max_size=2), max_size=2),
)  # fmt: skip
COLUMNS = {"run": "text", "seed": "whole", "x": "number", "flag": "truth?", "paths": "texts"}


@settings(
    max_examples=1_000, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True
)
@given(
    st.dictionaries(st.sampled_from([*COLUMNS, "other"]), st.tuples(cells, st.integers(0, 3)), max_size=6)
)  # fmt: skip
def test_any_table_is_read_as_asked_or_refused(tmp_path_factory, columns):
    rows = min((count for _, count in columns.values()), default=0)
    path = tmp_path_factory.getbasetemp() / "any.parquet"
    frame = pd.DataFrame({name: [value] * rows for name, (value, _) in columns.items()})
    frame.to_parquet(path)
    try:
        read = read_table(path, COLUMNS, "make it anew")
    except BadInput as error:
        (line,) = error.problems
        assert str(path) in line
        assert "\n" not in line
        return
    assert len(read)
    assert read["run"].map(type).eq(str).all()
    assert pd.api.types.is_integer_dtype(read["seed"])
    assert read["paths"].map(lambda paths: all(isinstance(path, str) for path in paths)).all()


def test_what_is_no_table_at_all_is_refused(tmp_path):
    path = Path(tmp_path / "x.parquet")
    for content in (b"", b"PAR1", b"nonsense" * 100):
        path.write_bytes(content)
        with pytest.raises(BadInput, match=r"x\.parquet: cannot be read: .*; make it anew"):
            read_table(path, {}, "make it anew")
    with pytest.raises(BadInput, match=r"x\.parquet: missing"):
        read_table(path.with_name("other") / "x.parquet", {}, "make it anew")
