"""The subcommand ``adopt``: what it is given, and what it says."""

import shutil
from pathlib import Path

import pytest

from upswing.cli.main import main
from upswing.runs.results import Results

AGENT = "def policy(observation):\n    return 0 if observation[1] > 0 else 2\n"


@pytest.fixture
def folder(results, tmp_path, monkeypatch):
    """A copy of the small study's results, and beside it an agent."""
    shutil.copytree(results.folder, tmp_path / "results")
    (tmp_path / "My_Agent.py").write_text(AGENT, "utf-8")
    monkeypatch.chdir(tmp_path)
    return Path("results")


def test_an_agent_gets_the_name_of_its_file_and_the_first_seed_of_the_study(folder, capsys):
    assert main(["adopt", "My_Agent.py:policy", "--task", "balancing"]) == 0
    said = capsys.readouterr().out
    assert "to repeat it" not in said  # `upswing train` would not take it
    assert "balancing/my-agent/alpha-none/seed-0\n" in said
    assert "as long as results/adopted/balancing/my-agent.json is there" in said
    assert "stands in its tables" in said
    assert list(Results(folder).cell("balancing/my-agent/alpha-none")["seed"]) == [0]
    assert main(["browse", "--print", "architecture=my-agent"]) == 0
    assert capsys.readouterr().out.endswith("runs/balancing/my-agent/alpha-none/seed-0.rrd\n")


def test_name_seeds_and_folder_can_be_given_and_tables_come_with_the_study(folder, capsys):
    (folder / "tables/runs.parquet").unlink()
    words = ["--task", "balancing", "--name", "lean", "--seed", "7", "--seed", "5"]
    assert main(["adopt", "My_Agent.py:policy", *words, "--results", str(folder)]) == 0
    assert "when the study is finished" in capsys.readouterr().out
    assert not (folder / "tables/runs.parquet").exists()
    assert main(["tables", str(folder)]) == 0
    assert list(Results(folder).cell("balancing/lean/alpha-none")["seed"]) == [5, 7]


@pytest.mark.parametrize(
    "words",
    [
        ["balancing/my-agent/alpha-none/seed-7"],
        ["balancing/my-agent/alpha-none"],
        ["--task", "balancing", "--architecture", "my-agent", "--seed", "7"],
    ],
)
def test_who_would_watch_an_adopted_agent_is_told_why_not_and_what_to_do(folder, capsys, words):
    assert main(["adopt", "My_Agent.py:policy", "--task", "balancing", "--seed", "7"]) == 0
    Path("My_Agent.py").unlink()  # nothing below asks the agent itself
    capsys.readouterr()
    assert main(["watch", *words, "--save", "watched.rrd"]) == 2
    said = capsys.readouterr().err
    assert "balancing/my-agent/alpha-none: is an adopted agent" in said
    assert len(said.splitlines()) <= 2  # the number of problems, and the problem
    assert not Path("watched.rrd").exists()
    follow, show = (one.split()[1:] for one in said.split("`")[3::2])
    assert main([*follow, "--from", "10", "--seconds", "1", "--to", "played.png"]) == 0
    assert main([*show, "--print"]) == 0
    assert capsys.readouterr().out.endswith("balancing/my-agent/alpha-none/seed-7.rrd\n")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["My_Agent.py:policy"], "missing option '--task'"),
        (["My_Agent.py:policy", "--task", "balance"], "task: balance: no task of results"),
        (["My_Agent.py", "--task", "balancing"], "agent: My_Agent.py: must be file.py:function"),
        (["My_Agent.py:polcy", "--task", "balancing"], "did you mean 'policy'?"),
        (
            ["My_Agent.py:policy", "--task", "balancing", "--seed", "-1"],
            "greater than or equal to 0",
        ),
        (["My_Agent.py:policy", "--task", "balancing", "--name", "table"], "name: table: is an"),
        (["My_Agent.py:policy", "--task", "balancing", "--results", "lost"], "lost/study.json"),
    ],
)
def test_what_is_wrong_is_one_line_and_code_2(folder, capsys, words, said):
    assert main(["adopt", *words]) == 2
    captured = capsys.readouterr()
    assert said in captured.err
    assert captured.err.startswith("upswing: ")
    assert len(captured.err.splitlines()) <= 2  # the number of problems, and the problem
    assert captured.out == ""
    assert not (folder / "adopted").exists()
