"""A folder for studies of one's own."""

import pytest

from tests.paths import ROOT
from upswing.cli.main import main
from upswing.study.errors import BadInput
from upswing.study.new_folder import write_folder


def names(folder):
    return {path.name for path in folder.iterdir()}


def test_it_holds_the_configuration_and_no_rules(tmp_path):
    folder = tmp_path / "a/mine"
    write_folder(folder)
    assert names(folder) == {"Snakefile", "config", "workflow"}
    assert names(folder / "workflow") == {"profiles"}
    for name in ("config/claims.yaml", "config/config.yaml", "config/README.md"):
        assert (folder / name).read_bytes() == (ROOT / name).read_bytes()
    assert not (folder / "config").is_symlink()
    assert names(folder.parent) == {"mine"}


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
