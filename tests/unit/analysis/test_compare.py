"""Comparing two folders of results."""

import pandas as pd
import pytest

from tests.made_up import FROM, ONE, ZERO, N, made_up, part, share_of
from upswing.analysis.compare import compare
from upswing.analysis.verdicts import write_verdicts
from upswing.cli.main import main
from upswing.runs.files.tables import write_table
from upswing.study.claims import Claim
from upswing.study.errors import BadInput
from upswing.study.paths import EVIDENCE, RUNS, VERDICTS


@pytest.fixture
def two_folders(tmp_path):
    """Two folders of results that are alike."""
    asked = part("share", [ONE], where={"swing_ups": {"at_least": 1}}, **FROM)
    claims = {"C1": Claim(statement="…", section="…", figure=5, cell=ONE, parts=[asked])}

    def make(name, x):
        write_verdicts(made_up(tmp_path / name, swing_ups=[x, ZERO, ZERO]), claims, {})
        return tmp_path / name

    return make


def test_the_same_results_compare_as_the_same(two_folders, capsys):
    a, b = two_folders("a", share_of(1)), two_folders("b", share_of(1))
    found = compare(a, b)
    assert found.common_runs == 3 * N
    assert not any((found.changed_verdicts, found.parted_estimates, found.changed_runs))
    assert main(["compare", str(a), str(b)]) == 0
    assert "every verdict is the same" in capsys.readouterr().out


def test_a_changed_verdict_and_a_changed_run_are_named(two_folders, capsys):
    a, b = two_folders("a", share_of(1)), two_folders("b", share_of(0.2))
    runs = pd.read_parquet(b / RUNS)
    runs.loc[runs["run"] == f"{ONE}/seed-3", "digest"] = "another"
    write_table(b / RUNS, runs)
    found = compare(a, b)
    assert found.changed_verdicts == [("C1", "reproduced", "not reproduced")]
    assert found.changed_runs == [f"{ONE}/seed-3"]
    assert [estimate[2:] for estimate in found.parted_estimates] == [(1.0, 0.2)]
    assert main(["compare", str(a), str(b)]) == 1
    assert "C1: reproduced → not reproduced" in capsys.readouterr().out


COMPARED = {
    RUNS: ["run", "digest"],
    VERDICTS: ["claim", "verdict"],
    EVIDENCE: ["claim", "part", "cells", "estimate", "low", "high"],
}
"""What two folders are compared by."""


def test_results_of_another_version_are_compared_by_what_they_have(two_folders):
    a, b = two_folders("a", share_of(1)), two_folders("b", share_of(0.2))
    before = compare(a, b)
    for table, columns in COMPARED.items():
        pd.read_parquet(a / table)[columns].assign(p_value=0.5).to_parquet(a / table)
    assert compare(a, b) == before
    assert before.changed_verdicts
    for table, columns in COMPARED.items():
        frame = pd.read_parquet(a / table)
        for column in columns:
            frame.drop(columns=column).to_parquet(a / table)
            with pytest.raises(
                BadInput, match=f"{table}: is no such table: it has no column {column}"
            ):
                compare(a, b)
        frame.to_parquet(a / table)


def test_a_folder_that_was_never_judged(two_folders, tmp_path, capsys):
    a = two_folders("a", share_of(1))
    assert main(["compare", str(a), str(tmp_path / "none")]) == 2
    assert "verdicts.parquet: missing" in capsys.readouterr().err
