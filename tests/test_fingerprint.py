"""What reruns: a change of meaning in a module that a job reaches, and nothing else."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from upswing import jobs
from upswing.config import Architecture
from upswing.fingerprint import fingerprint, reachable

TABLES, NETS = Architecture(learner="table"), Architecture(learner="networks", hidden=(5,))
SOURCE = Path(__file__).parents[1] / "src"
ASK = """
from upswing.config import Architecture
from upswing import jobs
print(*(jobs.training(Architecture(learner=name, hidden=hidden), "balancing").fingerprint
        for name, hidden in (("table", ()), ("networks", (5,)))), jobs.figure("fig05").fingerprint,
      jobs.page(["fig05"]).fingerprint)
"""
TABLE, NETWORKS, FIGURE, REPORT = range(4)


@pytest.fixture
def package(tmp_path):
    """A copy of the package to edit."""
    shutil.copytree(
        SOURCE / "upswing", tmp_path / "upswing", ignore=shutil.ignore_patterns("__pycache__")
    )
    return tmp_path


def ask(package):
    answer = subprocess.run(
        [sys.executable, "-c", ASK],
        env={**os.environ, "PYTHONPATH": str(package)},
        cwd=package,
        capture_output=True,
        text=True,
        check=True,
    )
    return answer.stdout.split()


def changed_by(package, file, old, new):
    before = ask(package)
    path = package / "upswing" / file
    text = path.read_text("utf-8")
    assert old in text
    path.write_text(text.replace(old, new), "utf-8")
    return {
        number for number, (a, b) in enumerate(zip(before, ask(package), strict=True)) if a != b
    }


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        ("pendulum.py", "# M_P, eq. 14", "# another comment", set()),
        ("pendulum.py", '"""The constants of §4.2.2."""', '"""Other words."""', set()),
        (
            "pendulum.py",
            "    dt = pendulum.time_step\n",
            "\n    dt   = (pendulum.time_step)\n",
            set(),
        ),
        (
            "loop.py",
            "range(first, last)",
            "range(first, last + 1)",
            {TABLE, NETWORKS, FIGURE, REPORT},
        ),
        ("learners/table.py", "+= share", "+= 2 * share", {TABLE}),
        ("learners/backpropagation/one_hidden.py", "STALE = -1", "STALE = -2", {NETWORKS}),
        ("figures/fig05.py", "5_000", "4_000", {FIGURE, REPORT}),
        ("figures/fig06.py", "import", "import math\nimport", set()),
        ("report/words.py", '"–"', '"-"', {REPORT}),
    ],
)
def test_who_notices_an_edit(package, file, old, new, expected):
    changed = changed_by(package, file, old, new)
    if "loop" in file:  # whoever reads a trajectory imports its type; training must be among them
        assert {TABLE, NETWORKS} <= changed <= expected
    else:
        assert changed == expected


def test_a_learner_is_reached_by_its_own_jobs_alone():
    assert "upswing.learners.networks" not in reachable("upswing.train")
    assert {"upswing.pendulum", "upswing.loop", "upswing.policy"} <= reachable("upswing.train")
    table, networks, other = (
        jobs.training(architecture, kind).fingerprint
        for architecture, kind in (
            (TABLES, "balancing"), (NETS, "balancing"), (TABLES, "full-control"),
        )
    )  # fmt: skip
    assert len({table, networks, other}) == 3


def test_versions_of_packages_belong_to_it():
    assert fingerprint("upswing.codings.grid") != fingerprint(
        "upswing.codings.grid", packages=["numpy"]
    )


def test_an_edited_pendulum_is_not_run_from_the_cache_of_the_old_one(package, tmp_path):
    """Numba's cache looks at the loop's own file only; its folder is keyed by the fingerprint."""
    fall = (
        "from upswing.pendulum import Pendulum, step; "
        "from tests.helpers import make_spec, run; "
        "print(float(run(make_spec('balancing', 'idle', steps=50))[0].angle[-1]))"
    )
    shutil.copytree(
        Path(__file__).parent, package / "tests", ignore=shutil.ignore_patterns("__pycache__")
    )

    def angle():
        answer = subprocess.run(
            [sys.executable, "-c", fall],
            env={**os.environ, "PYTHONPATH": str(package), "XDG_CACHE_HOME": str(tmp_path / "cache")},
            cwd=package, capture_output=True, text=True, check=True,
        )  # fmt: skip
        return float(answer.stdout)

    before = angle()
    assert angle() == before  # from the cache
    path = package / "upswing" / "pendulum.py"
    path.write_text(path.read_text("utf-8").replace("9.81", "1.62"), "utf-8")
    assert abs(angle()) < abs(before)
