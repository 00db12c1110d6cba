"""What is said of bad input."""

from collections.abc import Callable

import pytest

import upswing


def says(call: Callable[[], object]) -> str:
    """The one problem that a call names."""
    with pytest.raises(upswing.BadInput) as raised:
        call()
    (problem,) = raised.value.problems
    return problem
