"""What the tests of recordings share: the viewer written beside the report of a small study."""

from pathlib import Path

import pytest

from upswing.recordings.comparison import write_comparisons
from upswing.recordings.viewer import write_viewer


@pytest.fixture(scope="module")
def names(results):
    """The names of the recordings beside the report, which are written."""
    write_comparisons(results)
    return write_viewer(results, Path("report"))
