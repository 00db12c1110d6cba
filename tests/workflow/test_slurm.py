"""The smoke study on a real Slurm of one node, and the same tables as without it."""

import os
import shutil
import socket
import subprocess
import time
from pathlib import Path

import pandas as pd
import pytest

from tests.workflow.small_study import BIN, SMALL, Study

pytestmark = pytest.mark.heavy
PROGRAMS = ("slurmctld", "slurmd", "sbatch", "munged")
CONFIGURATION = Path("/etc/slurm/slurm.conf")


def missing():
    """Why there can be no Slurm here; empty if there can."""
    lacking = [p for p in PROGRAMS if not (shutil.which(p) or Path(f"/usr/sbin/{p}").exists())]
    if lacking:
        return f"no {', '.join(lacking)}: install Debian's packages slurm-wlm and munge"
    if os.getuid() != 0:
        return "only root can start a Slurm"
    if CONFIGURATION.exists():
        return f"{CONFIGURATION} exists: a Slurm is set up here, and is left alone"
    return ""


@pytest.fixture(scope="module")
def slurm(tmp_path_factory):
    """A Slurm of this machine alone, on loopback, without accounting; gone afterwards."""
    if reason := missing():
        pytest.skip(reason)
    folder, host = tmp_path_factory.mktemp("slurm"), socket.gethostname()
    for name in ("state", "spool"):
        (folder / name).mkdir()
    text = f"""\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc={folder}/completed.txt
MinJobAge=3600
ReturnToService=2
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
SchedulerParameters=batch_sched_delay=0,sched_min_interval=100000
NodeName={host} NodeAddr=127.0.0.1 CPUs={os.cpu_count()} RealMemory=4000 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
    CONFIGURATION.parent.mkdir(exist_ok=True)
    CONFIGURATION.write_text(text, "utf-8")
    had_munge = (
        subprocess.run(["pgrep", "munged"], capture_output=True, check=False).returncode == 0
    )
    daemons = []
    try:
        if not had_munge:
            run = Path("/run/munge")
            run.mkdir(exist_ok=True)
            shutil.chown(run, "munge", "munge")
            command = ["runuser", "-u", "munge", "--", "/usr/sbin/munged", "--foreground"]
            daemons.append(
                subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            )
            time.sleep(1)
        daemons += [
            subprocess.Popen(
                [f"/usr/sbin/{name}", "-D"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
            )
            for name in ("slurmctld", "slurmd")
        ]
        until = time.monotonic() + 60
        while "idle" not in (said := states()):
            if time.monotonic() > until:
                pytest.fail(
                    f"no Slurm: {said}\n{(folder / 'slurmctld.log').read_text('utf-8')[-2000:]}"
                )
            time.sleep(0.5)
        yield folder
    finally:
        subprocess.run(["scancel", "--user", "root"], capture_output=True, check=False)
        for daemon in reversed(daemons):
            daemon.terminate()
            try:
                daemon.wait(20)
            except subprocess.TimeoutExpired:
                daemon.kill()
        CONFIGURATION.unlink(missing_ok=True)


def states():
    done = subprocess.run(["sinfo", "-h", "-o", "%T"], capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


def rows(study):
    runs = pd.read_parquet(study.folder / "results/tables/runs.parquet")
    return runs.drop(columns=["seconds", "steps_per_second", "git_commit", "dirty"])


def test_slurm_makes_the_tables_that_one_machine_makes(slurm, tmp_path):
    local, cluster = (
        Study(tmp_path / name) for name in (folder(tmp_path, "a"), folder(tmp_path, "b"))
    )
    target, runs = "results/tables/verdicts.parquet", "results/tables/runs.parquet"
    done = local.snakemake("--", target, runs)
    assert done.returncode == 0, done.stdout + done.stderr
    done = subprocess.run(
        [
            BIN / "snakemake", "--profile", "workflow/profiles/slurm", "--configfile",
            "config/small.yaml", "--slurm-no-account", "--slurm-status-command", "squeue",
            "--slurm-init-seconds-before-status-checks", "3", "--seconds-between-status-checks", "2",
            "--latency-wait", "5", "--", target, runs,
        ],
        cwd=cluster.folder, env={
            **os.environ, "PATH": f"{BIN}:{os.environ['PATH']}", "PYTHONPATH": str(BIN.parent / "slurm"),
        },
        capture_output=True, text=True, check=False, timeout=400,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    pd.testing.assert_frame_equal(rows(cluster), rows(local))
    a, b = (pd.read_parquet(s.folder / target) for s in (local, cluster))
    pd.testing.assert_frame_equal(a, b)
    ran = (slurm / "completed.txt").read_text("utf-8").count("JobState=COMPLETED")
    # 5 cells; study, tables and verdicts are made where Snakemake itself runs
    assert ran == len(SMALL["experiments"][0]["architectures"]) + 1 + 2


def folder(parent, name):
    (parent / name).mkdir()
    return name
