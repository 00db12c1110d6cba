"""What reruns: a change of meaning in a module that a job reaches, and nothing else."""

import os
import shutil
import subprocess
import sys

import pytest

from tests.paths import ROOT
from upswing.study import jobs
from upswing.study.architecture import architecture_of
from upswing.study.fingerprint import fingerprint, reachable

TABLES = architecture_of(learner="table")
NETS = architecture_of(learner="networks", hidden=(5,))
SOURCE = ROOT / "src"
ASK = """
from upswing.study.architecture import architecture_of
from upswing.study import jobs
print(*(jobs.training(architecture_of(learner=name, **options), "balancing").fingerprint
        for name, options in (("table", {}), ("networks", {"hidden": (5,)}))), jobs.figure("fig05").fingerprint,
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
        ("physics/pendulum.py", "# M_P, eq. 14", "# another comment", set()),
        (
            "physics/pendulum.py",
            '"""The constants of §4.2.2, and what the actions do to the cart (§4.4)."""',
            '"""Other words."""',
            set(),
        ),
        (
            "physics/pendulum.py",
            "    dt = pendulum.time_step\n",
            "\n    dt   = (pendulum.time_step)\n",
            set(),
        ),
        (
            "runs/loop.py",
            "range(first, last)",
            "range(first, last + 1)",
            {TABLE, NETWORKS, FIGURE, REPORT},
        ),
        ("agents/learners/table.py", "+= share", "+= 2 * share", {TABLE}),
        ("agents/learners/backpropagation/one_hidden.py", "STALE = -1", "STALE = -2", {NETWORKS}),
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
    assert "upswing.agents.learners.networks" not in reachable("upswing.runs.train")
    assert {"upswing.physics.pendulum", "upswing.runs.loop", "upswing.agents.policy"} <= reachable(
        "upswing.runs.train"
    )
    table, networks, other = (
        jobs.training(architecture, kind).fingerprint
        for architecture, kind in (
            (TABLES, "balancing"), (NETS, "balancing"), (TABLES, "full-control"),
        )
    )  # fmt: skip
    assert len({table, networks, other}) == 3


def test_versions_of_packages_belong_to_it():
    assert fingerprint("upswing.agents.features.grid") != fingerprint(
        "upswing.agents.features.grid", packages=["numpy"]
    )


def test_an_edited_pendulum_is_not_run_from_the_cache_of_the_old_one(package, tmp_path):
    """Numba's cache looks at the loop's own file only; its folder is keyed by the fingerprint."""
    fall = (
        "from upswing.physics.pendulum import Pendulum, step; "
        "from tests.helpers import make_spec, run; "
        "print(float(run(make_spec('balancing', 'idle', steps=50))[0].angle[-1]))"
    )
    shutil.copytree(ROOT / "tests", package / "tests", ignore=shutil.ignore_patterns("__pycache__"))

    def angle():
        answer = subprocess.run(
            [sys.executable, "-c", fall],
            env={**os.environ, "PYTHONPATH": str(package), "XDG_CACHE_HOME": str(tmp_path / "cache")},
            cwd=package, capture_output=True, text=True, check=True,
        )  # fmt: skip
        return float(answer.stdout)

    before = angle()
    assert angle() == before  # from the cache
    path = package / "upswing" / "physics/pendulum.py"
    path.write_text(
        path.read_text("utf-8").replace(
            "(m * g * l / 2) * sin_angle", "(m * g * l / 12) * sin_angle"
        ),
        "utf-8",
    )
    assert abs(angle()) < abs(before)
