"""Accidents, for real: killed, out of disk or memory, in each other's way, failing inside a job."""

import contextlib
import os
import resource
import shutil
import signal
import subprocess
import sys
import time

import pandas as pd
import psutil
import pytest

from tests.helpers import make_spec
from tests.workflow.small_study import BIN, Study
from upswing.analysis.doctor import examine
from upswing.runs.ending import GO_ON
from upswing.runs.train import RunsFailed, train

SLOW = {
    "results": "results",
    "seeds": 4,
    "seeds_per_job": 2,
    "tasks": {"full-control": {"kind": "full-control", "steps": 6_000_000}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["full-control"], "architectures": ["table"], "alphas": [0.5]}],
}
RUNS = "results/tables/runs.parquet"
TABLES = ["--", RUNS]


@pytest.fixture
def study(tmp_path):
    """A study of a few seconds, not yet run."""
    study = Study(tmp_path)
    study.write(SLOW)
    return study


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """The rows of the same study, run without an accident."""
    study = Study(tmp_path_factory.mktemp("undisturbed"))
    study.write(SLOW)
    done = study.snakemake(*TABLES)
    assert done.returncode == 0, done.stdout + done.stderr
    return rows(study)


def rows(study):
    runs = pd.read_parquet(study.folder / RUNS)
    return runs.drop(columns=["seconds", "steps_per_second", "git_commit", "dirty"])


def begun(study):
    """Snakemake on the study, in a session of its own, when its first job is training."""
    process = subprocess.Popen(
        [
            BIN / "snakemake", "--cores", "2", "--profile", "workflow/profiles/default",
            "--configfile", "config/small.yaml", *TABLES,
        ],
        cwd=study.folder, env={**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"},
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True,
    )  # fmt: skip
    until = time.monotonic() + 60
    while time.monotonic() < until and process.poll() is None:
        if trainers(process) and list((study.folder / "results/logs").rglob("seeds_*.log")):
            time.sleep(0.5)
            return process
        time.sleep(0.05)
    pytest.fail(f"no job began: {process.stdout.read()}")


def trainers(process):
    """The training jobs below a Snakemake."""
    found = []
    with contextlib.suppress(psutil.NoSuchProcess):
        for child in psutil.Process(process.pid).children(recursive=True):
            with contextlib.suppress(psutil.NoSuchProcess):  # and no zombie
                command = child.cmdline()
                if "train" in command and "upswing" in " ".join(command[:2]):
                    found.append(child)
    return found


def whole(study):
    """Nothing that is there is damaged: it is missing or whole."""
    for file in (study.folder / "results/runs").rglob("*.parquet"):
        if not file.name.startswith("."):
            pd.read_parquet(file)
    found = examine(study.folder / "results").findings
    assert all(finding.what.startswith("missing") for finding in found)


@pytest.mark.heavy
@pytest.mark.parametrize("who", ["snakemake", "job", "both"])
def test_kill_9_loses_nothing_finished_and_a_rerun_ends_as_if_undisturbed(study, undisturbed, who):
    process = begun(study)
    jobs = trainers(process)
    if who in ("job", "both"):
        for job in jobs:
            job.kill()
    if who in ("snakemake", "both"):
        process.kill()
    process.wait(120)
    psutil.wait_procs(jobs, timeout=60)  # what was not killed goes on to its end
    assert (process.returncode != 0) or who == "job"
    if (study.folder / "results/study.json").exists():
        whole(study)
    again = study.snakemake(*TABLES)
    if who != "job":
        # One clear line, and what to do.
        assert again.returncode != 0
        assert "--unlock" in again.stdout + again.stderr
        assert study.snakemake("--unlock").returncode == 0
        again = study.snakemake(*TABLES)
    assert again.returncode == 0, again.stdout + again.stderr
    pd.testing.assert_frame_equal(rows(study), undisturbed)
    assert not examine(study.folder / "results").orphans


@pytest.mark.heavy
@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGTERM])
def test_asked_to_end_it_ends_its_jobs_and_goes_on_later(study, undisturbed, sign):
    process = begun(study)
    jobs = trainers(process)
    os.killpg(process.pid, sign)  # as a terminal does it
    output, _ = process.communicate(timeout=120)
    assert output.splitlines()[-1] == GO_ON
    _, alive = psutil.wait_procs(jobs, timeout=20)
    assert not alive
    again = study.snakemake(*TABLES)
    assert again.returncode == 0, again.stdout + again.stderr
    pd.testing.assert_frame_equal(rows(study), undisturbed)


@pytest.mark.heavy
def test_two_studies_at_once_in_one_folder_do_not_mix(study, undisturbed):
    process = begun(study)
    second = study.snakemake(*TABLES)
    assert second.returncode != 0
    assert "lock" in (second.stdout + second.stderr).lower()
    output, _ = process.communicate(timeout=120)
    assert process.returncode == 0, output
    pd.testing.assert_frame_equal(rows(study), undisturbed)


def trained(spec, results, **limits):
    """``upswing train`` in a process of its own, under limits."""

    def limit():
        for name, value in limits.items():
            resource.setrlimit(getattr(resource, name), (value, value))

    return subprocess.run(
        [sys.executable, "-m", "upswing.cli", "train", spec.canonical(), "--results", str(results)],
        capture_output=True, text=True, check=False, preexec_fn=limit,
    )  # fmt: skip


def test_a_full_disk_is_said_and_leaves_nothing_half_written(tmp_path):
    done = trained(make_spec(steps=20_000), tmp_path, RLIMIT_FSIZE=20_000)
    assert done.returncode == 1
    assert "balancing/table/alpha-1/seed-0" in done.stderr
    assert "File too large" in done.stderr
    assert "Traceback" not in done.stderr
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []
    assert trained(make_spec(steps=20_000), tmp_path).returncode == 0


def test_too_little_memory_is_said(tmp_path):
    spec = make_spec(steps=100_000_000)
    done = trained(spec, tmp_path, RLIMIT_AS=2_500_000_000)
    assert done.returncode == 1
    assert "upswing: not enough memory" in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.rglob("*.parquet"))


def test_results_that_cannot_be_written_are_said(tmp_path):
    (tmp_path / "results").write_text("a file", "utf-8")
    done = trained(make_spec(steps=2_000), tmp_path / "results")
    assert done.returncode == 1
    assert "seed-0" in done.stderr
    assert "Traceback" not in done.stderr


def test_a_run_that_fails_in_its_job_costs_only_itself(tmp_path, capsys):
    spec = make_spec(steps=3_000, seeds=(0, 1, 2))
    obstacle = tmp_path / "runs" / f"{spec.run(1)}.rrd"
    (obstacle / "in the way").mkdir(parents=True)
    with pytest.raises(RunsFailed, match=r"alpha-1/seed-1: \w+Error"):
        train(spec, tmp_path)
    before = {path.name: path.read_bytes() for path in (tmp_path / "runs").rglob("seed-[02].*")}
    assert len(before) == 8
    # Snakemake deletes all outputs of the failed job.
    shutil.rmtree(tmp_path / "runs")
    capsys.readouterr()
    train(spec, tmp_path)
    assert capsys.readouterr().out.count("was finished before") == 2
    after = {path.name: path.read_bytes() for path in (tmp_path / "runs").rglob("seed-[02].*")}
    assert after == before
    assert len(list((tmp_path / "runs").rglob("seed-*"))) == 12
    # What was kept is used once, and only for the same.
    train(spec, tmp_path)
    assert "was finished before" not in capsys.readouterr().out


def test_what_was_kept_is_not_used_for_another_specification_or_if_damaged(tmp_path, capsys):
    spec = make_spec(steps=3_000, seeds=(0, 1))
    obstacle = tmp_path / "runs" / f"{spec.run(1)}.rrd"
    for damage in ("another", "damaged"):
        (obstacle / "in the way").mkdir(parents=True)
        with pytest.raises(RunsFailed):
            train(spec, tmp_path)
        shutil.rmtree(tmp_path / "runs")
        capsys.readouterr()
        if damage == "damaged":
            (kept,) = tmp_path.glob(".kept/**/seed-0.rrd")
            kept.write_bytes(kept.read_bytes()[:100])
            train(spec, tmp_path)
        else:
            train(make_spec(steps=3_001, seeds=(0, 1)), tmp_path)
        assert "was finished before" not in capsys.readouterr().out
        shutil.rmtree(tmp_path / "runs")
