"""Everything that is written is checked before anything runs: files, names, folders, quantities."""

import re
import subprocess
import time

import pytest
import yaml

from tests.paths import ROOT
from tests.workflow.small_study import BIN, SMALL
from upswing.cli.main import main
from upswing.study.claims import load_claims
from upswing.study.config import load, validated
from upswing.study.errors import BadInput
from upswing.study.sweeps import groups, load_sweeps
from upswing.study.yaml_file import read_yaml

CLAIMS = yaml.safe_load((ROOT / "config/claims.yaml").read_text("utf-8"))


def yaml_of(tmp_path, text):
    path = tmp_path / "mine.yaml"
    path.write_text(text, "utf-8")
    return read_yaml(path)


@pytest.mark.parametrize(
    "scalar",
    ["!!int x", "!!bool perhaps", "0x_", "9" * 5_000, "!!float x", "!!timestamp x", "!!int", "!!binary é", "!!map x", "!!seq x", "!!set x", "!!pairs x", "!unknown x", "0b_", "-0o9:_"],
)  # fmt: skip
@pytest.mark.parametrize("place", ["seeds: {}", "tasks: {{a: {}}}", "x: [{}]"])
def test_a_scalar_that_python_refuses_is_one_line_with_its_own(tmp_path, scalar, place):
    try:
        yaml_of(tmp_path, f"first: 1\n{place.format(scalar)}\n")
    except BadInput as error:
        (said,) = error.problems
        assert re.search(r"mine.yaml: line [23]:", said)
        assert "\n" not in said
    else:  # then it is text
        assert scalar in ("0x_", "0b_", "-0o9:_")


def test_a_date_is_text(tmp_path):
    assert yaml_of(tmp_path, "a: 2001-13-45\nb: 2001-01-01") == {
        "a": "2001-13-45",
        "b": "2001-01-01",
    }


def test_merge_keys_bring_what_is_not_there_itself(tmp_path):
    text = "n: &n {learner: networks, hidden: [5]}\na: {<<: *n, hidden: [9]}\nb: {<<: [*n, {c: 1}]}"
    content = yaml_of(tmp_path, text)
    assert content["a"] == {"learner": "networks", "hidden": [9]}
    assert content["b"] == {"learner": "networks", "hidden": [5], "c": 1}
    with pytest.raises(BadInput, match="hidden: duplicate key"):
        yaml_of(tmp_path, "n: &n {a: 1}\nb: {<<: *n, hidden: 1, hidden: 2}")
    with pytest.raises(BadInput, match="only a mapping can be merged"):
        yaml_of(tmp_path, "b: {<<: 3}")


def test_nested_merges_cost_no_more_than_their_keys(tmp_path):
    levels = [f"a{n}: &a{n} {{<<: [*a{n - 1}, *a{n - 1}], k{n}: 1}}" for n in range(1, 40)]
    begin = time.process_time()
    content = yaml_of(tmp_path, "\n".join(["a0: &a0 {k0: 1}", *levels]))
    assert time.process_time() - begin < 5
    assert len(content["a39"]) == 40
    with pytest.raises(BadInput, match="nested too deeply"):
        yaml_of(tmp_path, "a: &a {<<: *a}")


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ({}, "must have at least 1"),
        ({"../../x": CLAIMS["C1"]}, "a claim's name has letters"),
        ({"<b>": CLAIMS["C1"]}, "a claim's name has letters"),
        ({"C1": {**CLAIMS["C1"], "cell": "balancing/tabel/alpha-1"}}, "did you mean 'balancing/table/alpha-1'"),
        ({"C1": 3}, "C1: 3: must hold keys and values"),
        ({"C1": {**CLAIMS["C1"], "parts": 3}}, "must be a list"),
        ({"C1": {**CLAIMS["C1"], "figure": "5"}}, "figure"),
        ({"C1": {**CLAIMS["C1"], "figure": 10**30}}, "figure"),
        ({"C1": {**CLAIMS["C1"], "statement": "a\0b"}}, "no control characters"),
        ({"C2": {**CLAIMS["C2"], "parts": [{**CLAIMS["C2"]["parts"][0], "only_if": {"ties": "first"}}]}}, "or nothing is asked"),
        ({"C2": {**CLAIMS["C2"], "parts": [{**CLAIMS["C2"]["parts"][0], "where": {"upright_share": {"at_least": 9}}}]}}, "upright_share lies between 0 and 1"),
    ],
)  # fmt: skip
def test_claims_are_checked_like_the_configuration(tmp_path, content, expected):
    path = tmp_path / "claims.yaml"
    path.write_text(yaml.safe_dump(content), "utf-8")
    (tmp_path / "config.yaml").write_bytes((ROOT / "config/config.yaml").read_bytes())
    with pytest.raises(BadInput, match=re.escape(expected)):
        load_claims(path, validated({"small": SMALL}))


CELL, NETWORKS = "balancing/table/alpha-1", "balancing/networks-5/alpha-1"
SWEEP = {"vary": ["ties"], "how": "grid", "seeds": 1, "cells": [CELL]}


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ({}, "must have at least 1"),
        ({"a": {**SWEEP, "cells_of_singles": [CELL]}}, "stands in `cells` too"),
        (
            {"a": {**SWEEP, "rounds": [{"readings": 1, "seeds": 2}]}},
            "a.reports: missing: rounds need them to say which readings go on",
        ),
        (
            {
                "a": {
                    **SWEEP,
                    "reports": {"p7": {"figure": 7, "cell": NETWORKS, "shows": "success"}},
                }
            },
            f'a.reports.p7: "{NETWORKS}": is run by no round; name it in `cells`',
        ),
        ({"a": {**SWEEP, "every": {NETWORKS: 2}}}, "a.every"),
        (
            {
                "a": {
                    **SWEEP,
                    "reports": {"p5": {"figure": 5, "cell": CELL, "shows": "failure"}},
                    "rounds": [{"readings": 1, "seeds": 1}],
                }
            },
            "each round has more seeds than the one before",
        ),
    ],
)
def test_sweeps_are_checked_like_the_configuration(tmp_path, content, expected):
    path = tmp_path / "readings.yaml"
    path.write_text(yaml.safe_dump(content), "utf-8")
    with pytest.raises(BadInput, match=re.escape(expected)):
        load_sweeps(path, validated({"small": SMALL}))


def test_a_grid_of_one_reading_has_a_name_for_its_job(tmp_path):
    path, study = tmp_path / "readings.yaml", validated({"small": SMALL})
    path.write_text(yaml.safe_dump({"a": SWEEP}), "utf-8")
    (group,) = groups(load_sweeps(path, study)["a"], study)
    assert (group.name, len(group.members)) == ("all", 2)


def test_all_problems_of_a_yaml_file_are_said_at_once(tmp_path):
    with pytest.raises(BadInput) as caught:
        yaml_of(tmp_path, "seeds: !!int x\n1: 2\na: {b: 1, b: !!bool y}\n")
    lines = [re.search(r"line (\d)", problem)[1] for problem in caught.value.problems]
    assert lines == ["1", "2", "3", "3"]


def test_aliases_that_multiply_are_shown_in_time(tmp_path):
    levels = [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 20)]
    text = "\n".join(["a0: &a0 [x]", *levels, "tasks: *a19", "seeds: *a19"])
    (tmp_path / "mine.yaml").write_text(text, "utf-8")
    begin = time.monotonic()
    with pytest.raises(BadInput, match=r"tasks: \[\[\["):
        load(tmp_path / "mine.yaml")
    assert time.monotonic() - begin < 5


def test_many_problems_are_counted_and_not_all_shown():
    with pytest.raises(BadInput, match=r"… and \d+ more$") as caught:
        validated({"mine.yaml": {**SMALL, "seeds": [-1] * 1_000}})
    assert len(caught.value.problems) >= 1_000
    assert len(str(caught.value).splitlines()) == 102


def test_claims_of_cells_that_another_study_here_has_are_fine():
    assert len(load_claims(ROOT / "config/claims.yaml", validated({"small": SMALL}))) == 16


def test_all_problems_of_all_files_are_said_at_once(tmp_path, capsys):
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump({**SMALL, "sede": 3}), "utf-8")
    (tmp_path / "claims.yaml").write_text("C1: 3", "utf-8")
    (tmp_path / "readings.yaml").write_text("$(touch pwned): 3", "utf-8")
    good = tmp_path / "good.yaml"
    good.write_text(yaml.safe_dump(SMALL), "utf-8")
    words = ["--claims", str(tmp_path / "claims.yaml"), "--sweeps", str(tmp_path / "readings.yaml")]
    assert main(["check", str(tmp_path / "mine.yaml"), *words]) == 2
    said = capsys.readouterr().err
    assert "sede" in said
    assert "claims.yaml: C1" in said
    assert main(["check", str(good), *words]) == 2
    said = capsys.readouterr().err
    assert "claims.yaml: C1" in said
    assert "readings.yaml" in said
    assert "a name has small letters" in said


def test_little_memory_is_one_line(tmp_path):
    command = f"ulimit -v 700000; exec '{BIN}/upswing' check '{ROOT}/config/config.yaml'"
    done = subprocess.run(
        ["bash", "-c", command], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert "Traceback" not in done.stderr
    assert done.returncode == 0 or len(done.stderr.strip().splitlines()) == 1, done.stderr
