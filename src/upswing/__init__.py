"""upswing: a reproduction of the bachelor's thesis *Reinforcement Learning in Motor Control*.

In a notebook: ``import upswing; study = upswing.open("results")``. What there is for it stands in
``upswing.api``, and is imported when it is first asked for, so that ``import upswing`` costs nothing.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from upswing.api import BadInput as BadInput
    from upswing.api import Cell as Cell
    from upswing.api import DifferentRun as DifferentRun
    from upswing.api import Policy as Policy
    from upswing.api import Run as Run
    from upswing.api import Study as Study
    from upswing.api import load as load
    from upswing.api import open as open
    from upswing.api import train as train

__version__ = "0.1.0"

FACE = ("BadInput", "Cell", "DifferentRun", "Policy", "Run", "Study", "load", "open", "train")
"""What is here for notebooks."""


def __getattr__(name: str) -> Any:
    if name in FACE:
        # By name: whoever imports this package for its version depends on nothing of that.
        from importlib import import_module

        return getattr(import_module("upswing.api"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *FACE})
