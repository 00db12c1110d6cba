"""What a public project has around its code: its forms are valid, and say what there is."""

import re
import subprocess
import sys

import pytest
import yaml

from tests.paths import ROOT

GITHUB = ROOT / ".github"


def valid(schema, *files):
    command = [
        sys.executable,
        "-m",
        "check_jsonschema",
        "--builtin-schema",
        schema,
        *map(str, files),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_workflow_is_valid_and_calls_the_one_command_on_every_supported_python():
    path = GITHUB / "workflows/ci.yml"
    valid("vendor.github-workflows", path)
    job = yaml.safe_load(path.read_text("utf-8"))["jobs"]["test"]
    assert [step["run"] for step in job["steps"] if "run" in step][-1] == ".ci/run"
    oldest = re.search(
        r'requires-python = ">=(3\.\d+)"', (ROOT / "pyproject.toml").read_text("utf-8")
    )[1]
    assert job["strategy"]["matrix"]["python"][0] == oldest


@pytest.mark.parametrize(
    "form", sorted((GITHUB / "ISSUE_TEMPLATE").glob("[!c]*.yml")), ids=lambda path: path.stem
)
def test_a_form_asks_for_what_it_needs(form):
    content = yaml.safe_load(form.read_text("utf-8"))
    assert {"name", "description", "body"} <= content.keys()
    names = [part["id"] for part in content["body"]]
    assert len(set(names)) == len(names)
    for part in content["body"]:
        assert part["type"] in ("input", "textarea", "dropdown")
        assert part["attributes"]["label"]


def test_the_form_for_verdicts_knows_every_claim():
    claims = yaml.safe_load((ROOT / "config/claims.yaml").read_text("utf-8"))
    body = yaml.safe_load((GITHUB / "ISSUE_TEMPLATE/verdict.yml").read_text("utf-8"))["body"]
    assert next(part for part in body if part["id"] == "claim")["attributes"]["options"] == list(
        claims
    )


def test_the_catalog_of_snakemake_workflows_can_read_what_is_said_of_this_one():
    usage = yaml.safe_load((ROOT / ".snakemake-workflow-catalog.yml").read_text("utf-8"))["usage"]
    assert set(usage) == {"mandatory-flags", "software-stack-deployment", "report"}
    assert usage["report"] is True  # rules annotate their outputs with report()
    assert "report(" in (ROOT / "workflow/rules/figures.smk").read_text("utf-8")


def test_a_wrong_import_breaks_the_contract_of_the_layers(tmp_path):
    import shutil

    shutil.copytree(ROOT / "src", tmp_path / "src", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    path = tmp_path / "src/upswing/physics/pendulum.py"
    lint = [sys.executable, "-c", "from importlinter.cli import lint_imports_command as main; main()", "--no-cache"]  # fmt: skip
    environment = {"PYTHONPATH": str(tmp_path / "src"), "PATH": "/usr/bin:/bin"}
    for added, code in (("", 0), ("\nfrom upswing.analysis import statistics  # noqa\n", 1)):
        path.write_text(path.read_text("utf-8") + added, "utf-8")
        done = subprocess.run(lint, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)  # fmt: skip
        assert done.returncode == code, done.stdout + done.stderr
    assert "upswing.physics.pendulum -> upswing.analysis.statistics" in done.stdout
