"""Studies held against each other: folders of results, and entries of a history."""

import json
import math
import shutil

import numpy as np
import pandas as pd
import pytest

from tests.made_up import FROM, NOISE, ONE, OTHER, STUDY, ZERO, N, made_up, part, share_of
from upswing.analysis.aggregate import summarise
from upswing.analysis.compare import Interval, compare
from upswing.analysis.history.called import sides
from upswing.analysis.history.sides import of_folder
from upswing.analysis.history.write import write_entry
from upswing.analysis.verdicts import write_verdicts
from upswing.cli.main import main
from upswing.runs.files.tables import write_table
from upswing.runs.study_file import canonical, write_study
from upswing.study.claims import Claim
from upswing.study.config import validated
from upswing.study.errors import BadInput
from upswing.study.paths import CELLS, EVIDENCE, RUNS, VERDICTS

SHARE = part("share", [ONE], where={"swing_ups": {"at_least": 1}}, **FROM)
MEASURED = {
    "upright_share": [NOISE, NOISE, NOISE], "above_horizontal_share": [ZERO] * 3,
    "mean_reward": [ZERO] * 3, "upright_at_end": [ZERO] * 3, "greedy_success_share": [ZERO] * 3,
    "first_stable_step": [np.full(N, np.nan)] * 3, "steps_per_second": [ZERO] * 3,
}  # fmt: skip


@pytest.fixture
def make(tmp_path):
    """Makes folders of results that differ in what is given."""

    def make(name, x, parts=(SHARE,), cells=False, more=None, **changes):
        claim = Claim(statement="…", section="…", figure=5, cell=ONE, parts=list(parts))
        measured = {**MEASURED, **(more or {})} if cells else {}
        found = made_up(tmp_path / name, swing_ups=[x, ZERO, ZERO], **measured)
        if changes:
            study = {**STUDY, **changes}
            write_study(canonical(validated({"study": study})), found.folder)
        write_verdicts(found, {"C1": claim}, {})
        if cells:
            runs = pd.read_parquet(found.folder / RUNS)
            runs["task"], runs["architecture"] = "balancing", "table"
            runs["alpha"] = runs["run"].str.extract(r"alpha-([\d.]+)/")[0].astype(float)
            write_table(found.folder / CELLS, summarise(runs))
        return found.folder

    return make


def compared(*folders):
    return compare([of_folder(folder) for folder in folders])


def test_the_same_results_compare_as_the_same(make, capsys):
    a, b = make("a", share_of(1), cells=True), make("b", share_of(1), cells=True)
    found = compared(a, b)
    assert (found.common_runs, found.same_cells) == (3 * N, 3)
    assert not any((found.verdicts, found.estimates, found.changed_runs, found.cells))
    assert found.configuration == []
    assert main(["compare", str(a), str(b)]) == 0
    said = capsys.readouterr().out
    assert "every verdict is the same" in said
    assert "the configuration is the same" in said
    assert "3 of 3 cells that both have are the same" in said
    assert f"0 of {3 * N} runs that both have are not identical" in said


def test_a_changed_verdict_and_a_changed_run_are_named(make, capsys):
    a, b = make("a", share_of(1)), make("b", share_of(0.2))
    runs = pd.read_parquet(b / RUNS)
    runs.loc[runs["run"] == f"{ONE}/seed-3", "digest"] = "another"
    write_table(b / RUNS, runs)
    found = compared(a, b)
    assert found.verdicts == [("C1", ("reproduced", "not reproduced"))]
    assert found.changed_runs == [f"{ONE}/seed-3"]
    (estimate,) = found.estimates
    assert [value.value for value in estimate.values] == [1.0, 0.2]
    assert main(["compare", str(a), str(b)]) == 1
    said = capsys.readouterr().out
    assert "C1: reproduced → not reproduced" in said
    assert "1 → 0.2, outside each other's intervals" in said
    assert f"1 of {3 * N} runs that both have are not identical" in said


def test_what_only_one_has_is_said_in_words(make, capsys):
    alone = part("share", [OTHER], where={"swing_ups": {"at_least": 1}}, **FROM)
    a, b = make("a", share_of(1)), make("b", share_of(1), parts=(SHARE, alone))
    found = compared(a, b)
    (estimate,) = found.estimates
    assert estimate.values[0] is None
    main(["compare", str(a), str(b)])
    said = capsys.readouterr().out
    assert "nan" not in said
    (line,) = [line for line in said.splitlines() if line.startswith("C1: part")]
    assert line.startswith(f"C1: part 2, {OTHER}: B 0 [0, ")
    assert line.endswith("; A has no estimate of it")
    main(["compare", str(b), str(a)])
    assert "; B has no estimate of it" in capsys.readouterr().out


def test_a_claim_without_runs_is_no_number_that_lies_apart(make, capsys):
    missing = part("share", ["balancing/table/alpha-0.9"], where={"falls": {"at_least": 1}}, **FROM)
    a, b = make("a", share_of(1), parts=[missing]), make("b", share_of(1), parts=[missing])
    assert compared(a, b).estimates == []
    frame = pd.read_parquet(b / EVIDENCE)
    assert frame["estimate"].isna().all()
    frame[["estimate", "low", "high"]] = 0.5, 0.4, 0.6
    frame.to_parquet(b / EVIDENCE)
    main(["compare", str(a), str(b)])
    said = capsys.readouterr().out
    assert "B 0.5 [0.4, 0.6]; A has no estimate of it" in said
    assert "nan" not in said


def test_the_difference_of_the_configurations_comes_first(make, capsys):
    a = make("a", share_of(1))
    b = make("b", share_of(0.2), epsilon=0.02, results="elsewhere")
    assert [row.key for row in compared(a, b).configuration] == ["epsilon"]
    main(["compare", str(a), str(b)])
    said = capsys.readouterr().out
    assert said.index("epsilon: 0.01 → 0.02") < said.index("C1: reproduced")


def test_cells_that_differ_stand_side_by_side_with_their_intervals(make, capsys):
    a = make("a", share_of(1), cells=True)
    b = make("b", share_of(1), cells=True, more={"upright_share": [NOISE + 1, NOISE, NOISE]})
    found = compared(a, b)
    (row,) = found.cells
    assert (row.cell, row.measure, found.same_cells) == (ONE, "upright share", 2)
    table = pd.read_parquet(b / CELLS).set_index("cell")
    expected = [table.loc[ONE, f"upright_share_mean{end}"] for end in ("", "_low", "_high")]
    assert row.values[1] == Interval(*expected)
    assert row.parted
    main(["compare", str(a), str(b)])
    said = capsys.readouterr().out
    assert f"{expected[0]:.4g} [{expected[1]:.4g}, {expected[2]:.4g}]" in said
    assert "2 of 3 cells that both have are the same" in said


def test_a_time_is_no_difference_and_a_last_digit_neither(make):
    a = make("a", share_of(1), cells=True)
    b = make("b", share_of(1), cells=True)
    frame = pd.read_parquet(b / CELLS)
    frame["steps_per_second_median"] += 1
    frame["falls_mean"] *= 1 + 1e-13
    write_table(b / CELLS, frame)
    assert compared(a, b).same_cells == 3


def test_cells_and_runs_that_not_all_have_are_named_with_who_has_them(make, capsys):
    a, b, c = (make(name, share_of(1), cells=True) for name in "abc")
    for folder, cell in ((a, OTHER), (c, ONE)):
        for table, name in ((CELLS, "cell"), (RUNS, "run")):
            frame = pd.read_parquet(folder / table)
            write_table(folder / table, frame[~frame[name].str.startswith(cell)])
    found = compared(a, b, c)
    assert found.partial_cells == [(ONE, (True, True, False)), (OTHER, (False, True, True))]
    assert (found.common_runs, found.same_cells) == (N, 1)
    main(["compare", str(a), str(b), str(c)])
    said = capsys.readouterr().out
    assert "1 cell is only in A and B" in said
    assert f"{N} runs are only in B and C" in said
    assert f"0 of {N} runs that all have are not identical" in said


def test_any_number_of_studies_is_compared(make, capsys):
    folders = [str(make(name, share_of(x))) for name, x in zip("abcd", (1, 1, 0.2, 1), strict=True)]
    assert main(["compare", *folders]) == 1
    said = capsys.readouterr().out
    assert "C1: reproduced → reproduced → not reproduced → reproduced" in said
    assert all(f"{letter}: the results in {folder}" in said for letter, folder in zip("ABCD", folders, strict=True))  # fmt: skip
    assert main(["compare", folders[0], folders[1], folders[3]]) == 0


def test_entries_of_a_history_are_compared_with_folders(make, capsys):
    a = make("a", share_of(1), cells=True)
    first = write_entry(a).entry
    b = make("b", share_of(0.2), cells=True)
    shutil.copytree(b / "tables", a / "tables", dirs_exist_ok=True)
    shutil.copytree(b / "checksums", a / "checksums", dirs_exist_ok=True)
    write_entry(a)
    assert main(["compare", "@1", "@last", "--results", str(a)]) == 1
    by_number = capsys.readouterr().out
    assert "C1: reproduced → not reproduced" in by_number
    assert main(["compare", first.id, str(b), "--results", str(a)]) == 1
    assert main(["compare", "@2", str(b), "--results", str(a)]) == 0
    assert main(["compare", "@1", "--results", str(a)]) == 1  # with the folder itself
    capsys.readouterr()
    assert main(["compare", "@1", "@7", str(a / "none"), "--results", str(a)]) == 2
    said = capsys.readouterr().err
    assert "2 problems" in said
    assert "@7: there is no such entry; there are @1 to @2" in said
    assert "none/tables/verdicts.parquet: missing" in said


def test_an_entry_is_its_folder_as_it_was(make):
    a = make("a", share_of(1), cells=True)
    write_entry(a)
    found = compare(sides(["@1", str(a)], a))
    assert found.configuration == []
    assert not any((found.cells, found.verdicts, found.estimates, found.changed_runs))
    assert not found.partial_runs


COMPARED = {
    RUNS: ["run", "digest"],
    VERDICTS: ["claim", "verdict"],
    EVIDENCE: ["claim", "part", "cells", "estimate", "low", "high"],
}
"""What two folders are compared by, whatever else they have."""


def test_results_of_another_version_are_compared_by_what_they_have(make, capsys):
    a, b = make("a", share_of(1)), make("b", share_of(0.2))
    before = compared(a, b)
    for table, columns in COMPARED.items():
        pd.read_parquet(a / table)[columns].assign(p_value=0.5).to_parquet(a / table)
    assert compared(a, b) == before
    assert before.verdicts
    for table, columns in COMPARED.items():
        frame = pd.read_parquet(a / table)
        for column in columns:
            frame.drop(columns=column).to_parquet(a / table)
            with pytest.raises(
                BadInput, match=f"{table}: is no such table: it has no column {column}"
            ):
                compared(a, b)
        frame.to_parquet(a / table)


def test_an_old_folder_that_says_nothing_of_its_study_is_compared(make, capsys):
    a, b = make("a", share_of(1), cells=True), make("b", share_of(0.2), cells=True)
    (a / "study.json").unlink()
    (a / CELLS).unlink()
    shutil.rmtree(a / "checksums")
    assert main(["compare", str(a), str(b)]) == 1
    said = capsys.readouterr().out
    assert "the configurations are not compared: one has no study.json" in said
    assert "the cells are not compared" in said
    assert "C1: reproduced → not reproduced" in said


def test_a_study_of_another_version_is_compared_as_it_was_written(make):
    a, b = make("a", share_of(1)), make("b", share_of(1))
    study = json.loads((a / "study.json").read_text("utf-8"))
    (a / "study.json").write_text(json.dumps({**study, "of_old": 7}), "utf-8")
    assert [(row.key, *row.values) for row in compared(a, b).configuration] == [
        ("of_old", "7", "–")
    ]
    del study["discount"]  # a key that an older version did not write has its default
    (a / "study.json").write_text(json.dumps(study), "utf-8")
    assert compared(a, b).configuration == []


def test_a_folder_that_was_never_judged(make, tmp_path, capsys):
    a = make("a", share_of(1))
    assert main(["compare", str(a), str(tmp_path / "none")]) == 2
    assert "verdicts.parquet: missing" in capsys.readouterr().err


def test_many_differences_are_named_where_all_are_asked_for(make, capsys):
    a, b = make("a", share_of(1)), make("b", share_of(1))
    runs = pd.read_parquet(b / RUNS)
    runs["digest"] = "another"
    write_table(b / RUNS, runs)
    assert main(["compare", str(a), str(b)]) == 0
    assert f"… and {3 * N - 10} more" in capsys.readouterr().out
    assert main(["compare", str(a), str(b), "--all"]) == 0
    assert capsys.readouterr().out.count("/seed-") == 3 * N


def test_an_estimate_without_an_interval_lies_nowhere_apart():
    nothing = math.nan
    assert not Interval(1, nothing, nothing).parted_from(Interval(2, nothing, nothing))
    assert Interval(1, 0.5, 1.5).parted_from(Interval(2, 0.5, 2.5))
    assert Interval(1, 0, 3).parted_from(Interval(2, 1.5, 2.5))
    assert not Interval(1, 0, 3).parted_from(Interval(2, 0.5, 2.5))
