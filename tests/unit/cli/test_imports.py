"""Nothing is imported that a subcommand does not need; modules are counted, for time depends on the machine."""

import json
import subprocess
import sys

import pytest

from tests.paths import ROOT
from upswing.runs.study_file import canonical
from upswing.study.config import load

HEAVY = {"torch", "rerun", "matplotlib", "pandas", "pyarrow", "scipy", "numba", "rich"}

LIGHT = {"upswing.study", "upswing.study.places"}
"""Where files are, which help says; they import nothing."""

PROGRAM = """
import json, os, sys
from upswing.cli.main import main
code = main(sys.argv[1:])
print(json.dumps([code, sorted(sys.modules)]), file=sys.stderr)
"""


def imported(*words):
    """The exit code, and the modules that are there after a subcommand in a process of its own."""
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, *words], cwd=ROOT, capture_output=True, text=True, check=True
    )  # fmt: skip
    code, names = json.loads(done.stderr.splitlines()[-1])
    return code, set(names)


def ours(names):
    return {
        name for name in names if name.startswith("upswing.") and not name.startswith("upswing.cli")
    }


@pytest.mark.parametrize("words", [["--help"], ["--version"]])
def test_help_needs_the_command_line_and_nothing_else(words):
    code, names = imported(*words)
    assert code == 0
    assert names & (HEAVY | {"numpy", "pydantic", "yaml"}) == set()
    assert ours(names) <= LIGHT


@pytest.mark.parametrize("name", ["verdicts", "train", "screenshots", "history", "compare"])
def test_the_help_of_a_subcommand_needs_nothing_that_it_runs(name):
    code, names = imported(name, "--help")
    assert code == 0
    assert names & (HEAVY | {"numpy"}) == set()
    assert ours(names) <= LIGHT


def test_a_mistake_needs_nothing_of_ours():
    code, names = imported("figur")
    assert code == 2
    assert names & (HEAVY | {"numpy"}) == set()
    assert ours(names) <= LIGHT


def test_the_names_of_the_figures_need_no_figure():
    _, names = imported("figure", "--help")
    assert names & (HEAVY | {"numpy"}) == set()
    assert {name for name in ours(names) if name.startswith("upswing.figures.fig")} == set()


def test_to_keep_a_study_needs_what_reads_a_configuration(tmp_path):
    study = canonical(load(ROOT / "config/smoke.yaml"))
    code, names = imported("study", study, "--results", str(tmp_path))
    assert code == 0
    assert names & HEAVY == set()
    assert {name.split(".")[1] for name in ours(names)} == {"study", "runs"}


def test_to_check_a_configuration_and_what_is_there_of_it_needs_what_reads_both():
    code, names = imported("check", "config/smoke.yaml")
    assert code == 0
    assert names & HEAVY == set()
    assert {name.split(".")[1] for name in ours(names)} == {"study", "runs"}


def test_to_list_a_history_needs_no_table(tmp_path):
    code, names = imported("history", "--results", str(tmp_path))
    assert code == 0
    assert names & (HEAVY | {"numpy"}) == set()


@pytest.mark.parametrize("words", [["schema"], ["keys"]])
def test_to_describe_a_configuration_needs_no_results(words):
    code, names = imported(*words)
    assert code == 0
    assert names & HEAVY == set()
    assert {name.split(".")[1] for name in ours(names)} == {"study"}


def test_verdicts_need_neither_networks_nor_pictures(tmp_path):
    code, names = imported("verdicts", "--results", str(tmp_path))
    assert code == 2
    assert names & {"torch", "rerun", "matplotlib", "rich"} == set()
