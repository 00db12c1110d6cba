"""A folder for studies of one's own."""

import re
import subprocess

import pytest

from tests.paths import ROOT
from upswing.cli.main import main
from upswing.study.config import load
from upswing.study.errors import BadInput
from upswing.study.new_folder import CONFIGURATIONS, write_folder


def names(folder):
    return {path.name for path in folder.iterdir()}


def test_it_holds_the_configuration_and_no_rules(tmp_path):
    folder = tmp_path / "a/mine"
    write_folder(folder)
    assert names(folder) == {"Snakefile", "README.md", "config", "workflow"}
    assert names(folder / "workflow") == {"profiles"}
    for name in ("config/claims.yaml", "config/smoke.yaml", "config/schema.json"):
        assert (folder / name).read_bytes() == (ROOT / name).read_bytes()
    assert not (folder / "config").is_symlink()
    assert names(folder.parent) == {"mine"}


def test_it_holds_the_projects_files_and_nobody_elses_and_no_command_of_a_checkout(tmp_path):
    tracked = subprocess.run(
        ["git", "ls-files", "config"], cwd=ROOT, capture_output=True, text=True, check=True
    ).stdout.splitlines()  # fmt: skip
    assert sorted(f"config/{name}" for name in CONFIGURATIONS) == sorted(tracked)
    write_folder(tmp_path / "mine")
    assert names(tmp_path / "mine/config") == set(CONFIGURATIONS)
    for path in (tmp_path / "mine").rglob("*.*"):
        if path.suffix in (".yaml", ".md"):
            said = path.read_text("utf-8")
            assert ".venv/bin" not in said, path
            assert not re.search(r"\bmake (study|beyond|reproduce|smoke|readings)\b", said), path
    template = (tmp_path / "mine/config/template.yaml").read_text("utf-8")
    assert "#     snakemake --cores all --configfile config/mine.yaml\n" in template
    for name in ("config.yaml", "template.yaml", "beyond.yaml"):
        assert load(tmp_path / "mine/config" / name) is not None


def test_the_templates_come_where_they_are_asked_for(tmp_path, capsys):
    assert main(["init", str(tmp_path / "mine"), "--templates"]) == 0
    assert (tmp_path / "mine/report/index.html.j2").is_file()
    assert (tmp_path / "mine/CITATION.cff").is_file()
    assert "snakemake --cores all" in capsys.readouterr().out


def test_an_empty_folder_is_taken_and_a_full_one_is_left_as_it_is(tmp_path, capsys):
    (tmp_path / "empty").mkdir()
    write_folder(tmp_path / "empty")
    before = names(tmp_path / "empty")
    with pytest.raises(BadInput, match="is not empty"):
        write_folder(tmp_path / "empty", templates=True)
    assert names(tmp_path / "empty") == before
    (tmp_path / "file").touch()
    assert main(["init", str(tmp_path / "file")]) == 2
    assert len(capsys.readouterr().err.splitlines()) == 2
