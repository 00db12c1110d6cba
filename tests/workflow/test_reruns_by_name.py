"""What is loaded by name reruns what uses it too: sweeps, gated cells, the bound and the search."""

import re

import pytest
import yaml

from tests.workflow.small_study import Edited

pytestmark = pytest.mark.heavy  # it runs studies with sweeps, or beyond the thesis

CONFIG = {
    "results": "results",
    "seeds": [5000],
    "tasks": {
        "balancing": {"kind": "balancing", "steps": 3_000},
        "full-control": {"kind": "full-control", "steps": 3_000},
    },
    "architectures": {
        "table": {"learner": "table"},
        "networks-5": {"learner": "networks", "hidden": [5]},
        "gated-table": {"learner": "gated"},
        "gated-networks": {"learner": "gated", "hidden": [5]},
        "tilings": {"learner": "table", "coding": "tilings"},
        "sarsa": {"learner": "table", "method": "sarsa"},
    },
    "experiments": [
        {"title": "Both tasks", "tasks": ["balancing", "full-control"], "architectures": ["table"], "alphas": [0.1]},
        {"title": "Networks", "tasks": ["balancing"], "architectures": ["networks-5", "gated-networks"], "alphas": [1]},
        {"title": "Others", "tasks": ["balancing"], "architectures": ["gated-table", "tilings", "sarsa"], "alphas": [0.1]},
    ],
    "search": {
        "task": "full-control", "seeds": [1000], "lengths": [3_000],
        "candidates": [{"title": "a table", "architectures": ["table"], "alphas": [0.1]}],
    },
}  # fmt: skip
READINGS = {
    "of-table": {"cells": ["full-control/table/alpha-0.1"], "vary": ["ties"]},
    "of-networks": {"cells": ["balancing/networks-5/alpha-1"], "vary": ["biases"]},
}
TRAINED = {
    "balancing/table", "full-control/table", "balancing/networks-5", "balancing/gated-networks",
    "balancing/gated-table", "balancing/tilings", "balancing/sarsa",
}  # fmt: skip
SWEEPS = {"of-table", "of-networks"}
TARGETS = (
    "results/tables/changes.parquet",
    "results/tables/shortest.parquet",
    *(f"results/readings/{sweep}/as-the-study.parquet" for sweep in sorted(SWEEPS)),
)


def rerun(study):
    """What would be trained, swept, solved and searched anew."""
    done = study.snakemake("--dry-run", "--", *TARGETS)
    text = done.stdout + done.stderr
    assert done.returncode == 0, text
    found = set()
    for job in re.split(r"^(?=(?:local)?rule )", text, flags=re.MULTILINE):
        rule = re.match(r"(?:local)?rule (\w+):", job)
        asked = dict(re.findall(r"(\w+)=([^,\s]+)", job.partition("wildcards:")[2]))
        if rule and rule[1].startswith("train_"):
            found.add(asked["cell"].rpartition("/")[0])
        elif rule and rule[1] == "sweep":
            found.add(asked["sweep"])
        elif rule and rule[1] in ("bound", "shortest"):
            found.add(rule[1])
    return found


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A study with sweeps, changes, a bound and a search, all of them done at small size."""
    study = Edited(tmp_path_factory.mktemp("named"))
    study.write(CONFIG)
    sweeps = {name: {**sweep, "how": "pairs", "seeds": 1} for name, sweep in READINGS.items()}
    (study.folder / "config/readings.yaml").write_text(yaml.safe_dump(sweeps), "utf-8")
    study.edit("src/upswing/optimal/settling.py", "Grid(180, 201)", "Grid(36, 21)")
    study.edit("src/upswing/optimal/prediction.py", "Grid(720, 801)", "Grid(72, 81)")
    study.edit("src/upswing/optimal/prediction.py", "42_000, 3_000_000", "42_000, 3_000")
    study.edit(
        "src/upswing/optimal/prediction.py", "range(43_000, 43_100)", "range(43_000, 43_001)"
    )
    study.edit(
        "src/upswing/optimal/prediction.py", "range(40_000, 40_020)", "range(40_000, 40_001)"
    )
    study.edit("src/upswing/optimal/bound.py", "(Grid(180, 201), Grid(360, 401), Grid(720, 801))", "(Grid(36, 21), Grid(72, 81))")  # fmt: skip
    study.edit("src/upswing/optimal/tile_rows.py", "BUDGET = 600", "BUDGET = 2")
    study.edit("src/upswing/optimal/tile_rows.py", "FURTHER = 3_000", "FURTHER = 2")
    done = study.snakemake("--", *TARGETS)
    assert done.returncode == 0, done.stdout + done.stderr
    assert rerun(study) == set()
    return study


U = "src/upswing/"


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        (
            "agents/algorithms/q_learning.py", "NOTHING_OPEN = -1", "NOTHING_OPEN = -2",
            TRAINED - {"balancing/sarsa"} | SWEEPS | {"bound", "shortest"},
        ),
        (
            "physics/tasks/full_control.py", "start_angle=pi", "start_angle=pi * 1.0",
            {"full-control/table", "of-table", "bound", "shortest"},
        ),
        (
            "agents/features/grid.py", "UPSWING_MODULE = 1", "UPSWING_MODULE = 1 + 0",
            TRAINED | SWEEPS | {"bound", "shortest"},  # tilings are shifted grids
        ),
        (
            "agents/learners/table.py", "+= share", "+= share * 1.0",
            TRAINED - {"balancing/networks-5", "balancing/gated-networks"} | {"of-table", "bound", "shortest"},
        ),
        (
            "agents/learners/networks.py", "class Networks", "NEW = 1\n\n\nclass Networks",
            {"balancing/networks-5", "balancing/gated-networks", "of-networks"},
        ),
        ("agents/learners/gated.py", "RATE = 0.1", "RATE = 0.2", {"balancing/gated-table", "balancing/gated-networks"}),
    ],
)  # fmt: skip
def test_an_edit_reruns_exactly_what_uses_it(study, file, old, new, expected):
    path = study.folder / U / file
    text = path.read_text("utf-8")
    study.edit(U + file, old, new)
    try:
        assert rerun(study) == expected
    finally:
        path.write_text(text, "utf-8")
