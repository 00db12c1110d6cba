"""The wheel, installed outside the checkout: a folder for studies is written, and a study made in it."""

import os
import shutil
import subprocess
import sys
import sysconfig
import zipfile

import pytest
import yaml

from tests.paths import ROOT
from tests.workflow.test_module import TINY

BUILT_FROM = (
    "pyproject.toml", "README.md", "LICENSE", "CITATION.cff", "Snakefile", "workflow", "config",
    "report", "src",
)  # fmt: skip
COMES_ALONG = ("Snakefile", "CITATION.cff", "workflow", "config", "report")


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    """A wheel of the checkout as it is, built in a copy."""
    copy, place = tmp_path_factory.mktemp("copy"), tmp_path_factory.mktemp("wheel")
    for name in BUILT_FROM:
        if (ROOT / name).is_dir():
            left_out = shutil.ignore_patterns("__pycache__", "*.egg-info")
            shutil.copytree(ROOT / name, copy / name, symlinks=True, ignore=left_out)
        else:
            shutil.copy(ROOT / name, copy / name)
    code = f"from setuptools.build_meta import build_wheel; build_wheel({str(place)!r})"
    subprocess.run([sys.executable, "-c", code], cwd=copy, capture_output=True, check=True)
    (built,) = place.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def python(wheel, tmp_path_factory):
    """The interpreter of an environment with the wheel, and with our environment's other packages."""
    place = tmp_path_factory.mktemp("environment") / "venv"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", place], check=True)
    python = place / "bin/python"
    subprocess.run(
        [
            sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--no-deps",
            "--no-index", "--disable-pip-version-check", wheel,
        ],
        check=True,
    )  # fmt: skip
    (packages,) = place.glob("lib/python*/site-packages")
    (packages / "others.pth").write_text(sysconfig.get_path("purelib"), "utf-8")
    return python


def called(python, folder, *words):
    """What a program beside ``python`` says, run in a folder without anything of ours around."""
    program = [python, "-m", "snakemake"] if words[0] == "snakemake" else [python.parent / words[0]]
    surroundings = {key: text for key, text in os.environ.items() if key != "PYTHONPATH"}
    return subprocess.run(
        [*program, *words[1:]], cwd=folder, env={**surroundings, "PATH": "/usr/bin:/bin"},
        capture_output=True, text=True, check=False,
    )  # fmt: skip


def test_the_wheel_holds_the_projects_own_files_and_none_twice(wheel):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    expected = {
        f"upswing/project/{path.relative_to(ROOT)}"
        for name in COMES_ALONG
        for path in ([ROOT / name] if (ROOT / name).is_file() else (ROOT / name).rglob("*"))
        if path.is_file()
    }
    assert {name for name in names if name.startswith("upswing/project/")} == expected
    assert not [name for name in names if name.split("/")[0] in ("config", "report", "workflow")]


@pytest.mark.heavy
def test_a_study_is_made_where_there_is_no_checkout(python, tmp_path):
    done = called(python, tmp_path, "upswing", "init", "mine")
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "mine"
    for subcommand in (["check"], ["check", "config/smoke.yaml", "--folder"]):
        done = called(python, folder, "upswing", *subcommand)
        assert done.returncode == 0, done.stderr
    (folder / "config/tiny.yaml").write_text(yaml.safe_dump({**TINY, "results": "out"}), "utf-8")
    done = called(
        python, folder, "snakemake", "--cores", "2", "--configfile", "config/tiny.yaml",
        "--", "out/report/index.html", "out/report/viewer/index.html",
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    page = (folder / "out/report/index.html").read_text("utf-8")
    assert "With α = 1 the table learns to balance" in page
    for subcommand in ("verdicts", "doctor"):
        done = called(python, folder, "upswing", subcommand, "out")
        assert done.returncode == 0, done.stdout + done.stderr
    assert "were not judged again" not in done.stdout


@pytest.mark.parametrize("subcommand", ["readme", "exploratory", "screenshots"])
def test_what_renews_the_projects_files_says_that_it_needs_a_checkout(python, tmp_path, subcommand):
    done = called(python, tmp_path, "upswing", subcommand)
    assert done.returncode == 2
    assert done.stderr.splitlines()[1:] == [
        f"  upswing {subcommand}: needs a checkout of the project, whose files it renews"
    ]
    assert not list(tmp_path.iterdir())
