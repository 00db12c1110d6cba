"""What the tests of the workflow share: a small study that is run once, and a Snakemake that is ready to run."""

import pytest

from tests.shared import shared
from tests.workflow import warm
from tests.workflow.small_study import run_once


@pytest.fixture(scope="session", autouse=True)
def _ended():
    yield
    warm.end()


@pytest.fixture(scope="session")
def once(tmp_path_factory):
    """The folder of the small study, run once in a session; for copies of it (``as_run``)."""
    return shared(tmp_path_factory, "small", run_once)
