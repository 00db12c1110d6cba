"""A small study that has the cells of figures 5 to 11, run and judged, and its figures."""

from pathlib import Path

import pandas as pd
import pytest

from tests.helpers import ARCHITECTURES
from tests.shared import copied
from upswing.analysis.aggregate import write_tables
from upswing.analysis.verdicts import write_verdicts
from upswing.figures import FIGURES, claims_of, drawable
from upswing.figures.style import plt
from upswing.runs.files.atomic import written
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.runs.train import train
from upswing.study import loading
from upswing.study.claims import load_claims
from upswing.study.config import validated
from upswing.study.matrix import Matrix
from upswing.study.paths import TILES

STEPS = 6_000
STUDY = {
    "seeds": 3,
    "tasks": {
        "balancing": {"kind": "balancing", "steps": STEPS},
        "full-control": {"kind": "full-control", "steps": STEPS},
        "full-control-long": {"kind": "full-control", "steps": STEPS + 1_000},
    },
    "architectures": {
        name: ARCHITECTURES[name]
        for name in (
            "table", "modular-table", "networks-5", "networks-20-5", "networks-30",
            "modular-networks-5", "idle", "random",
        )
    },
    "experiments": [
        {"tasks": ["balancing"], "architectures": ["table"], "alphas": [1, 0.75, 0.5, 0.001]},
        {"tasks": ["balancing"], "architectures": ["networks-5"], "alphas": [1, 0.5]},
        {"tasks": ["full-control"], "architectures": ["table", "modular-table"], "alphas": [0.01, 0.001]},
        {
            "tasks": ["full-control"], "alphas": [1],
            "architectures": ["networks-5", "networks-20-5", "networks-30", "modular-networks-5"],
        },
        {"tasks": ["full-control-long"], "architectures": ["table"], "alphas": [0.001]},
        {"tasks": ["balancing", "full-control"], "architectures": ["idle", "random"]},
    ],
}  # fmt: skip


@pytest.fixture(scope="session")
def claims():
    """The claims of the thesis."""
    return load_claims(Path("config/claims.yaml"))


@pytest.fixture(scope="session")
def study(tmp_path_factory, claims):
    """Such a study; that a table can represent the task for three of four starts is made up."""
    return Results(copied(tmp_path_factory, "figures", lambda folder: _run(folder, claims)))


def _run(folder, claims):
    asked = validated({"study": STUDY})
    matrix = Matrix(asked)
    write_study(canonical(asked), folder)
    for spec in matrix.cells.values():
        train(spec, folder)
    write_tables(folder, matrix)
    starts = pd.DataFrame({"angle": [-3.0, -1.0, 1.0, 3.0], "success": [True, True, False, True]})
    with written(folder / TILES) as beside:
        starts.to_parquet(beside)
    write_verdicts(Results(folder), claims, {})


@pytest.fixture(scope="session")
def drawings(study, claims):
    """Every figure of it, drawn and not stored."""
    return {name: drawn(name, study, claims) for name in drawable(study.cells)}


def drawn(name, results, claims):
    """A figure, drawn and not stored."""
    own = (claims_of(name, claims),) if FIGURES[name].number else ()
    drawing = loading.load("figures", name).draw(results, *own)
    drawing.figure.canvas.draw()
    plt.close(drawing.figure)  # it can still be looked at
    return drawing
