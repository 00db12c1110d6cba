"""What ``import upswing`` has for a notebook, and what it does not load for it."""

import subprocess
import sys

import pytest
import yaml

import upswing
from tests.paths import ROOT
from upswing.api.thesis import ARCHITECTURES, TASKS
from upswing.study.config import Study


def test_everything_is_there_and_listed():
    assert set(upswing.FACE) <= set(dir(upswing))
    for name in upswing.FACE:
        assert getattr(upswing, name).__doc__
    assert upswing.open.__module__ == "upswing.api.study"


def test_what_is_not_there_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'opn'"):
        upswing.opn  # noqa: B018


def test_it_works_outside_of_the_checkout(tmp_path):
    program = (
        "import sys, upswing; light = not {'numpy', 'pandas'} & set(sys.modules); "
        "run = upswing.train('balancing', 'table', 0.5, seed=3, steps=500); print(light, run)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    assert done.stdout == "True <run balancing/table/alpha-0.5/seed-3, learned here>\n"
    assert list(tmp_path.iterdir()) == []


def test_the_thesis_is_that_of_the_configuration():
    """``upswing.train`` has its names without the file; both must say the same."""
    written = yaml.safe_load((ROOT / "config/config.yaml").read_text("utf-8"))
    assert written["tasks"] == TASKS
    assert written["architectures"] == ARCHITECTURES
    defaults = Study.model_fields
    for key in ("epsilon", "discount"):
        assert written[key] == defaults[key].default
    readings = defaults["readings"].default_factory().model_dump()
    assert {key: readings[key] for key in written["readings"]} == written["readings"]


def test_nothing_below_imports_it():
    """The contract of the layers says so too; this one needs no import-linter."""
    below = [path for path in (ROOT / "src/upswing").rglob("*.py") if "api" not in path.parts]
    importing = [
        path.name
        for path in below
        if path.name != "__init__.py" and "upswing.api" in path.read_text("utf-8")
    ]
    assert importing == []
