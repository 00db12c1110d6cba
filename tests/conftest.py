"""What the tests of several files share."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

from tests.helpers import ARCHITECTURES
from tests.leftovers import _nothing_left_running  # noqa: F401  a fixture of every session
from tests.paths import ROOT
from tests.shared import copied
from upswing.analysis.aggregate import write_tables
from upswing.analysis.verdicts import write_verdicts
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.runs.train import train
from upswing.study.claims import load_claims
from upswing.study.config import validated
from upswing.study.matrix import Matrix

if TYPE_CHECKING:
    from playwright.sync_api import Browser

# The first call of what is compiled takes as long as compiling it: no example has a deadline.
settings.register_profile("upswing", deadline=None)
settings.load_profile("upswing")
os.chdir(ROOT)  # as the project is used, from whichever folder the tests are run

STUDY = {
    "seeds": 3,
    "tasks": {
        "balancing": {"kind": "balancing", "steps": 7_000},
        "full-control": {"kind": "full-control", "steps": 7_000},
    },
    "architectures": {
        name: ARCHITECTURES[name] for name in ("table", "modular-networks-5", "idle")
    },
    "experiments": [
        {"tasks": ["balancing"], "architectures": ["table"], "alphas": [1, 0.1]},
        {"tasks": ["full-control"], "architectures": ["modular-networks-5"], "alphas": [1]},
        {"tasks": ["balancing"], "architectures": ["idle"]},
    ],
}


def _small_results(folder: Path) -> None:
    study = validated({"study": STUDY})
    matrix = Matrix(study)
    write_study(canonical(study), folder)
    for spec in matrix.cells.values():
        train(spec, folder)
    write_tables(folder, matrix)
    write_verdicts(Results(folder), load_claims(Path("config/claims.yaml")), {})


@pytest.fixture(scope="session")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    """A small study, run and judged: each worker has a copy, which gets whatever is made of it."""
    return Results(copied(tmp_path_factory, "results", _small_results))


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the files that take longest: the workflow's. A file stays on one worker (loadfile)."""
    items.sort(key=lambda item: "workflow" not in item.path.parts)


CHROMIUM = Path("/usr/bin/chromium")


@pytest.fixture(scope="session")
def browser() -> Iterator["Browser"]:
    """A Chromium without a screen that draws in software."""
    if not CHROMIUM.exists():
        pytest.skip("no Chromium: install Debian's package chromium")
    options = [
        "--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
        "--disable-background-networking", "--disable-component-update",
    ]  # fmt: skip
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=options)
        yield chromium
        chromium.close()
