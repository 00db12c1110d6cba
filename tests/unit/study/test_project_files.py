"""The project's own files: where they are found, and that all of them come along."""

import subprocess
from pathlib import Path

import pytest

from tests.paths import ROOT
from upswing.study.claims import load_claims
from upswing.study.errors import BadInput
from upswing.study.project_files import (
    CLAIMS,
    PROJECT,
    SWEEPS,
    TEMPLATES,
    along,
    files_of_module,
    files_of_workflow,
    is_own,
)


def test_the_links_lead_to_the_projects_own_files():
    listed = subprocess.run(
        ["git", "ls-files", "Snakefile", "CITATION.cff", "workflow", "config", "report"],
        cwd=ROOT, capture_output=True, text=True, check=False,
    ).stdout.split()  # fmt: skip
    if not listed:
        pytest.skip("not a git checkout")
    for name in listed:
        assert (PROJECT / name).samefile(ROOT / name), name


def test_a_file_is_the_working_folders_or_else_comes_along(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert along(CLAIMS) == ROOT / CLAIMS
    assert load_claims(along(CLAIMS))
    CLAIMS.parent.mkdir()
    CLAIMS.touch()
    assert along(CLAIMS) == CLAIMS
    assert along(Path("config/none.yaml")) == Path("config/none.yaml")
    assert not is_own(CLAIMS)


def test_a_workflow_reads_the_working_folder_before_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert files_of_workflow(ROOT)[:3] == (ROOT / CLAIMS, ROOT / SWEEPS, ROOT / TEMPLATES)
    CLAIMS.parent.mkdir()
    CLAIMS.touch()
    assert files_of_workflow(ROOT)[:2] == (CLAIMS, ROOT / SWEEPS)


def test_rules_that_are_not_on_this_disk_read_what_the_package_has(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for found in (files_of_workflow(tmp_path / "gone"), files_of_module(tmp_path / "gone", {})[0]):
        assert found.claims.samefile(ROOT / CLAIMS)
        assert found.config.samefile(ROOT / "config/config.yaml")


def test_a_module_reads_the_workflows_files_and_those_that_are_named(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    CLAIMS.parent.mkdir()
    CLAIMS.touch()  # the other workflow's own, whatever it is
    assert files_of_module(ROOT, {"seeds": 2}) == (files_of_module(ROOT, {})[0], {"seeds": 2})
    assert files_of_module(ROOT, {})[0].claims == ROOT / CLAIMS
    Path("mine.yaml").touch()
    found, study = files_of_module(ROOT, {"seeds": 2, "claims": "mine.yaml"})
    named = {
        "seeds": 2,
        "claims": "mine.yaml",
    }  # the results must know whose claims they are judged by
    assert (found.claims, found.sweeps, study) == (Path("mine.yaml"), ROOT / SWEEPS, named)


def test_what_a_module_names_must_be_there():
    with pytest.raises(BadInput) as caught:
        files_of_module(ROOT, {"claims": "nowhere.yaml", "templates": 3})
    assert caught.value.problems == [
        'config of the module: claims: "nowhere.yaml": must be a file',
        "config of the module: templates: 3: must be a folder",
    ]
