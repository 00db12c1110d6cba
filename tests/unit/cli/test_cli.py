"""The subcommands, from outside: what they answer to bad input."""

import json

import pytest

from tests.helpers import make_spec
from upswing.cli.main import main

GOOD = make_spec(steps=100).canonical()


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["train", "{", "--results", "R"], "spec: \"{\": is not JSON"),
        (["train", GOOD, '{"alpha": 2}', "--results", "R"], "spec: alpha: 2: "),
        (["train", json.dumps({**json.loads(GOOD), "seeds": [-1]}), "--results", "R"], "spec: seeds[0]: -1"),
        (["study", "{}", "--results", "R"], "study: tasks: missing"),
        (["tables", "R"], "study.json: missing"),
        (["figure", "4", "R"], "figure: fig04: no such figure; did you mean 'fig"),
        (["figure", "5", "R"], "study.json: missing"),
        (["report", "R"], "study.json: missing"),
        (["check", "none.yaml"], "none.yaml: cannot be read"),
    ],
)  # fmt: skip
def test_bad_input_is_one_message_a_code_and_nothing_written(tmp_path, capsys, arguments, expected):
    results = tmp_path / "results"
    code = main([str(results) if part == "R" else part for part in arguments])
    errors = capsys.readouterr().err
    assert code == 2
    assert expected in errors
    assert "Traceback" not in errors
    assert not results.exists()


def test_results_that_cannot_be_written(tmp_path, capsys):
    (tmp_path / "file").write_text("", "utf-8")
    assert main(["train", GOOD, "--results", str(tmp_path / "file")]) == 1
    assert "seed-0" in capsys.readouterr().err


def test_check_says_what_a_study_comes_to(capsys):
    assert main(["check", "config/smoke.yaml"]) == 0
    assert "34 cells, 68 runs" in capsys.readouterr().out


def test_without_a_verb_the_usage_is_shown(capsys):
    with pytest.raises(SystemExit) as stopped:
        main([])
    assert stopped.value.code == 2
    assert "SUBCOMMAND" in capsys.readouterr().err
