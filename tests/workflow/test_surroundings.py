"""Whatever is set, missing or forbidden around the project: it works, or says so in one line."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.paths import ROOT
from tests.workflow.small_study import BIN, SMALL, Study

BARE = {
    "PATH": "/usr/bin:/bin",
    "HOME": str(Path.home()),
    "PYTHONPATH": str(ROOT / "src"),
}


def test_plain_snakemake_works_without_the_environment_on_the_path_and_in_another_encoding(
    tmp_path,
):
    folder = tmp_path / "with blanks, and Übung Δφ"
    folder.mkdir()
    study = Study(folder)
    study.write({**SMALL, "seeds": 1, "experiments": SMALL["experiments"][:1]})
    done = subprocess.run(
        [BIN / "snakemake", "--cores", "2", "--configfile", "config/small.yaml", "--",
         "results/tables/verdicts.parquet"],
        cwd=folder, env={**BARE, "PYTHONUTF8": "0", "LC_ALL": "C", "LANG": "C"}, umask=0o027,
        capture_output=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr.decode()
    assert "α" in (folder / "results/logs/verdicts.log").read_text("utf-8")
    made = {
        path: path.stat().st_mode & 0o777
        for path in (folder / "results").rglob("*")
        if path.is_file()
    }
    assert made
    # Whoever shares the folder by its group can read all of it, and nobody else can.
    assert [path for path, mode in made.items() if mode & 0o040 == 0 or mode & 0o027] == []


def test_a_subcommand_prints_in_utf_8_whatever_the_encoding(tmp_path):
    done = subprocess.run(
        [BIN / "upswing", "keys"], env={**BARE, "PYTHONUTF8": "0", "LC_ALL": "C"},
        capture_output=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr.decode()
    assert "α" in done.stdout.decode("utf-8")


def test_without_a_home_what_is_compiled_lasts_as_long_as_the_process():
    code = (
        "from upswing.physics.jit import config; from upswing.physics.tasks import wrapped;"
        "assert wrapped(0.5) == 0.5; print(config.CACHE_DIR)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], env={**BARE, "HOME": "/proc"},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert not Path(done.stdout.strip()).exists()


def test_snakemake_beside_which_upswing_is_missing_says_so(tmp_path):
    Study(tmp_path)
    code = (
        "import importlib.util as u; find = u.find_spec;"
        "u.find_spec = lambda name, *rest: None if name == 'upswing' else find(name, *rest);"
        "from snakemake.cli import main; main(['--dry-run', '--configfile', 'config/small.yaml'])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode != 0
    said = done.stdout + done.stderr
    assert "upswing is not installed beside this snakemake" in said
    assert "Traceback" not in said


def test_make_takes_nothing_from_outside_that_chooses_packages_or_encoding(tmp_path):
    shutil.copy(ROOT / "Makefile", tmp_path)
    surroundings = {
        **BARE, "HOME": "/proc", "PYTHONPATH": "/elsewhere", "PYTHONHOME": "/nowhere", "PYTHONUTF8": "0",
    }  # fmt: skip
    done = subprocess.run(
        ["make", "--no-print-directory", "--eval", "show:; @env", "show"],
        cwd=tmp_path, env=surroundings, capture_output=True, text=True, check=True,
    )  # fmt: skip
    shown = dict(line.split("=", 1) for line in done.stdout.splitlines() if "=" in line)
    assert "PYTHONPATH" not in shown
    assert "PYTHONHOME" not in shown
    assert shown["PYTHONUTF8"] == "1"
    assert shown["XDG_CACHE_HOME"] == str(tmp_path / ".cache")


def test_a_checkout_that_cannot_be_written_is_said_in_one_line(tmp_path):
    shutil.copy(ROOT / "Makefile", tmp_path)
    read_only = f"mount --bind '{tmp_path}' '{tmp_path}' && mount -o remount,ro,bind '{tmp_path}'"
    if subprocess.run(["unshare", "-m", "sh", "-c", read_only], capture_output=True, check=False).returncode:  # fmt: skip
        pytest.skip("no mount namespace can be made here")
    done = subprocess.run(
        ["unshare", "-m", "sh", "-c", f"{read_only} && make -C '{tmp_path}' smoke"],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode != 0
    said = [line for line in done.stderr.splitlines() if not line.startswith("make")]
    assert len(said) == 1
    assert said[0].startswith(f"upswing: {tmp_path}: cannot be written")
