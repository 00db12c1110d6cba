"""Rerun's program, found without importing it."""

import sys
from importlib.util import find_spec
from pathlib import Path


def _program() -> Path:
    found = find_spec("rerun_cli")
    if found is None or found.origin is None:
        return Path(sys.executable).with_name("rerun")
    folder = Path(found.origin).parent
    bundled = folder / "Rerun.app/Contents/MacOS/Rerun"
    return bundled if bundled.exists() else folder / "rerun"


RERUN = _program()
"""Rerun's program itself. ``bin/rerun`` starts it as a second process, which outlives the first."""
