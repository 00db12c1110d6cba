"""The subcommands, from outside: what they answer to bad input, and with which code."""

import json
import re
import shlex
import subprocess

import pytest
import yaml

from tests.helpers import make_spec
from tests.paths import ROOT
from tests.unit.cli.terminal import BOXES, UPSWING, in_terminal
from upswing.cli.main import PANELS, main
from upswing.cli.panel import Job
from upswing.study.config import load
from upswing.study.matrix import Matrix

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


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ([], "missing command (see `upswing --help`)"),
        (["figur"], "no such command 'figur'. Did you mean 'figure'? (see `upswing --help`)"),
        (["--loud"], "no such option: --loud (see `upswing --help`)"),
        (["tables", "--loud"], "no such option: --loud (see `upswing tables --help`)"),
        (["figure"], "missing argument 'FIGURE' (see `upswing figure --help`)"),
        (["train"], "missing argument 'SPEC' (see `upswing train --help`)"),
        (["tables", "a", "b"], "unexpected extra argument"),
        (["browse", "--port", "many"], "invalid value for '--port'"),
        (["tables", "--results"], "'--results' requires an argument"),
    ],
)  # fmt: skip
def test_a_mistake_in_the_command_is_one_plain_line(arguments, expected, capsys):
    assert main(arguments) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith("upswing: ")
    assert said.err.endswith("\n")
    assert said.err.count("\n") == 1
    assert expected in said.err


def test_it_is_as_plain_in_a_terminal():
    shown = in_terminal(80, "figur", NO_COLOR="1")
    assert (
        shown == "upswing: no such command 'figur'. Did you mean 'figure'? (see `upswing --help`)\n"
    )
    assert not BOXES.search(shown)


def test_results_that_cannot_be_written(tmp_path, capsys):
    (tmp_path / "file").write_text("", "utf-8")
    assert main(["train", GOOD, "--results", str(tmp_path / "file")]) == 1
    assert "seed-0" in capsys.readouterr().err


@pytest.mark.parametrize(
    "error", [MemoryError("8 GB"), OSError("no disk"), RuntimeError("no luck")]
)
def test_another_failure_is_a_line_and_code_1(error, monkeypatch, capsys, tmp_path):
    def fail(*_):
        raise error

    monkeypatch.setattr("upswing.runs.study_file.write_study", fail)
    assert main(["study", "{}", "--results", str(tmp_path)]) == 1
    said = capsys.readouterr().err
    assert said.startswith("upswing: ")
    assert str(error) in said
    assert said.count("\n") == 1


def test_a_mistake_of_ours_keeps_its_traceback(monkeypatch, tmp_path):
    def fail(*_):
        raise KeyError("ours")

    monkeypatch.setattr("upswing.runs.study_file.write_study", fail)
    with pytest.raises(KeyError):
        main(["study", "{}", "--results", str(tmp_path)])


def test_check_says_what_a_study_comes_to(capsys):
    cells = Matrix(load(ROOT / "config/smoke.yaml")).cells
    assert main(["check", "config/smoke.yaml"]) == 0
    assert f"{len(cells)} cells, {2 * len(cells)} runs" in capsys.readouterr().out


def test_check_says_what_is_there_and_how_long_the_rest_takes(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "study.yaml"
    content = {
        "results": "mine", "seeds": 2, "tasks": {"balancing": {"kind": "balancing", "steps": 300}},
        "architectures": {"table": {"learner": "table"}},
        "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1, 0.5]}],
    }  # fmt: skip
    path.write_text(yaml.safe_dump(content), "utf-8")
    assert main(["check", str(path)]) == 0
    *_, last = capsys.readouterr().out.splitlines()
    assert last.startswith("mine: none is there, 4 are to be trained: about ")
    assert last.endswith("by what such jobs usually take; the runs take about 1 MB")
    assert main(["check", str(path), "--begin"]) == 0
    said = capsys.readouterr()
    assert (said.out, said.err) == ("mine\n", f"{last}\n")
    spec = Matrix(load(path)).cells["balancing/table/alpha-1"]
    assert main(["train", spec.canonical(), "--results", "mine"]) == 0
    capsys.readouterr()
    assert main(["check", str(path)]) == 0
    assert "mine: 2 of 4 runs are there, 2 are to be trained: about" in capsys.readouterr().out
    path.write_text(yaml.safe_dump({**content, "epsilon": 0.02}), "utf-8")
    assert main(["check", str(path)]) == 0
    said = capsys.readouterr().out
    assert "0 of 4 runs are there, 4 are to be trained, 2 of them anew, for the conf" in said


def test_nobody_reads_to_the_end():
    """As in ``upswing keys | head -1``: no traceback, and nothing about a broken pipe."""
    command = [UPSWING, "keys"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 1


def jobs():
    """The subcommands that are jobs, by name; of a group, such as ``history``, the group's name."""
    named = [(command.name, command) for panel in PANELS for command in panel.registered_commands]
    named += [
        (group.name, command)
        for panel in PANELS
        for group in panel.registered_groups
        for command in group.typer_instance.registered_commands
    ]
    return {
        name: command
        for name, command in named
        if command.cls is not None and issubclass(command.cls, Job)
    }


def test_every_log_of_the_workflow_begins_with_how_to_repeat_it():
    rules = "".join(path.read_text("utf-8") for path in (ROOT / "workflow/rules").glob("*.smk"))
    called = set(re.findall(r'"\{params.upswing:q\} ([a-z-]+) .*> \{log:q\}', rules))
    assert called > {"tables", "verdicts", "figure", "report"}
    # Training says it for each run, in the run's own log.
    # Nobody but a user writes all comparisons in one go.
    assert called - {"train"} == jobs().keys() - {"comparisons"}


def test_a_job_is_repeated_by_the_first_line_of_its_log(tmp_path, capsys):
    text = json.dumps({"what": 'isn\'t "a" study'})
    given = ["study", text, "--results", str(tmp_path / "a folder")]
    code, first = main(given), capsys.readouterr()
    words = shlex.split(first.out.splitlines()[0].removeprefix("to repeat it: "))
    assert words == ["upswing", *given]
    assert (main(words[1:]), capsys.readouterr()) == (code, first)
