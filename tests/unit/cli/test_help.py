"""The help: groups as panels in a terminal and as headings in a pipe; and completion in a shell."""

import os
import re
import shlex
import shutil
import subprocess

import pytest

from tests.paths import ROOT
from tests.unit.cli.terminal import ANSI, BOXES, UPSWING, columns_of, in_pipe, in_terminal
from upswing import __version__
from upswing.cli.main import PANELS, main
from upswing.figures import NAMES

TITLES = ["Run", "Look", "Compare", "Maintain", "Called by the workflow"]
SUBCOMMANDS = [
    command.name
    for panel in PANELS
    for command in (*panel.registered_commands, *panel.registered_groups)
]
OTHERS = ("claims", "beyond-claims", "readings", "registration")
"""Files beside the configurations that are none."""

WITHOUT_DETECTION = {"_TYPER_COMPLETE_TEST_DISABLE_SHELL_DETECTION": "1"}


def test_the_groups_are_panels_in_a_terminal():
    shown = ANSI.sub("", in_terminal(80, "--help"))
    panels = re.findall(r"^╭─ (.+?) ─+╮$", shown, re.MULTILINE)
    assert panels == ["Options", *TITLES]
    assert re.findall(r"^│ ([a-z][a-z-]*)  ", shown, re.MULTILINE) == SUBCOMMANDS
    assert max(map(columns_of, shown.splitlines())) <= 80


def test_the_groups_are_headings_in_a_pipe():
    shown = in_pipe("--help").stdout
    assert re.findall(r"^(\S.*):$", shown, re.MULTILINE) == ["Options", *TITLES]
    assert re.findall(r"^  ([a-z][a-z-]*)  ", shown, re.MULTILINE) == SUBCOMMANDS
    assert not BOXES.search(shown)
    assert not ANSI.search(shown)


@pytest.mark.parametrize("name", SUBCOMMANDS)
def test_every_subcommand_has_help_in_80_columns(name, capsys):
    assert main([name, "--help"]) == 0
    said = capsys.readouterr().out
    assert f"Usage: upswing {name} " in said
    assert "to repeat it" not in said
    assert max(map(columns_of, said.splitlines())) <= 80


@pytest.mark.parametrize("show", [in_pipe, lambda *words: in_terminal(80, *words)])
def test_the_help_of_figure_lists_the_figures(show):
    shown = show("figure", "--help")
    shown = shown if isinstance(shown, str) else shown.stdout
    listed = " ".join(ANSI.sub("", shown).split()).partition("The figures: ")[2].rstrip(".")
    assert listed.split(", ") == list(NAMES)


def test_the_version(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"upswing {__version__}\n"


def completed(*words, by="bash"):
    """What a shell is told for the last of these words, as its completion asks."""
    asked = ["upswing", *words]
    return in_pipe(
        COMP_WORDS=shlex.join(asked[:-1]) + f" {asked[-1]}",
        COMP_CWORD=str(len(words)),
        _TYPER_COMPLETE_ARGS=shlex.join(asked[:-1]) + f" {asked[-1]}",
        _UPSWING_COMPLETE=f"complete_{by}",
    ).stdout.split()


def test_figures_are_completed():
    assert completed("figure", "") == list(NAMES)
    assert completed("figure", "fig1") == ["fig10", "fig11"]
    assert completed("figure", "step") == ["step-sizes"]


def test_subcommands_and_options_are_completed():
    assert completed("comp") == ["compare", "comparison", "comparisons"]
    assert completed("verdicts", "--d") == ["--details"]


def test_configurations_are_completed_and_no_other_file_beside_them():
    studies = sorted(
        f"config/{path.name}"
        for path in (ROOT / "config").glob("*.yaml")
        if path.stem not in OTHERS
    )
    assert {"config/accelerations.yaml", "config/config.yaml", "config/smoke.yaml"} <= set(studies)
    assert completed("check", "") == studies
    assert completed("check", "config/s") == ["config/smoke.yaml"]
    assert completed("check", "elsewhere/") == []  # which leaves it to the shell


def test_a_shell_that_shows_purposes_gets_them():
    assert '"doctor":"Check that a folder of results is whole' in " ".join(
        completed("doc", by="zsh")
    )


@pytest.mark.skipif(shutil.which("bash") is None, reason="no bash")
def test_a_bash_that_reads_the_script_completes(tmp_path):
    script = in_pipe("--show-completion", "bash", **WITHOUT_DETECTION).stdout
    asked = f"{script}\nCOMP_WORDS=(upswing figure over); COMP_CWORD=2\n"
    function = re.search(r"complete .*-F (\w+) upswing", script)[1]
    done = subprocess.run(
        ["bash", "--norc", "-c", f'{asked}{function} upswing; echo "${{COMPREPLY[@]}}"'],
        env={**os.environ, "PATH": f"{UPSWING.parent}:{os.environ['PATH']}"},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == "overview\n"


def test_completion_is_installed_for_the_user(tmp_path):
    done = in_pipe("--install-completion", "bash", HOME=str(tmp_path), **WITHOUT_DETECTION)
    assert done.returncode == 0, done.stderr
    sourced = (tmp_path / ".bashrc").read_text("utf-8")
    (installed,) = re.findall(r"source '(.+)'", sourced)
    script = in_pipe("--show-completion", "bash", **WITHOUT_DETECTION).stdout
    assert (tmp_path / installed).read_text("utf-8").strip() == script.strip()
