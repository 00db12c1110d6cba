"""What the tests of the programming interface share: the small study, opened."""

import pytest

import upswing
from upswing.runs.results import Results


@pytest.fixture(scope="session")
def study(results: Results) -> upswing.Study:
    """The small study, as a reader opens it."""
    return upswing.open(results.folder)
