"""What the tests of recordings share: the viewer written beside the report of a small study."""

from pathlib import Path

import pytest

from upswing.recordings.comparison import write_comparisons
from upswing.recordings.viewer import write_viewer
from upswing.study.claims import load_claims


@pytest.fixture(scope="module")
def names(results):
    """The names of the recordings beside the report, which are written."""
    claims = load_claims(Path("config/claims.yaml"))
    write_comparisons(results, claims)
    return write_viewer(results, claims, Path("report"))
