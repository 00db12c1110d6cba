"""How an architecture is shown: read, refused where it could not be seen, and part of no run."""

import pytest

from tests.helpers import ARCHITECTURES
from upswing.study import jobs
from upswing.study.config import validated
from upswing.study.contrast import OF_LINES, contrast
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix, canonical_search


def study(**shown):
    return validated({"mine.yaml": {
        "seeds": 2,
        "tasks": {"full-control": {"kind": "full-control", "steps": 500}},
        "architectures": {"networks-5": {**ARCHITECTURES["networks-5"], **shown}},
        "experiments": [{"tasks": ["full-control"], "architectures": ["networks-5"], "alphas": [1]}],
        "search": {
            "task": "full-control", "seeds": [7], "lengths": [100],
            "candidates": [{"title": "a", "architectures": ["networks-5"], "alphas": [1]}],
        },
    }})  # fmt: skip


def test_no_run_depends_on_how_it_is_shown():
    plain, shown = study(), study(colour="#7A2048", label="five units")
    cell = "full-control/networks-5/alpha-1"
    of_both = [Matrix(one).cells[cell] for one in (plain, shown)]
    assert of_both[0].canonical() == of_both[1].canonical()
    assert "five units" not in of_both[1].model_dump_json()
    codes = [
        jobs.training(one.architectures["networks-5"], "full-control").fingerprint
        for one in (plain, shown)
    ]
    assert codes[0] == codes[1]
    assert canonical_search(plain) == canonical_search(shown)


def test_what_training_imports_knows_nothing_of_it():
    modules = jobs.training(study().architectures["networks-5"], "full-control").modules
    assert not {f"upswing.study.{name}" for name in ("shown", "config", "own_figures")} & modules


@pytest.mark.parametrize(
    ("shown", "expected"),
    [
        ({"colour": "red"}, 'write a colour as "#0072B2"'),
        ({"colour": "#12345"}, 'write a colour as "#0072B2"'),
        ({"colour": "0072B2F"}, 'write a colour as "#0072B2"'),
        ({"colour": "#GG0000"}, 'write a colour as "#0072B2"'),
        ({"colour": "#FFFF00"}, "too pale to be seen on white"),
        ({"colour": 12}, "must be text"),
        ({"label": ""}, "label"),
        ({"label": "x" * 41}, "label"),
        ({"color": "#0072B2"}, "unknown key: did you mean 'colour'?"),
    ],
)
def test_what_cannot_be_shown_is_refused(shown, expected):
    with pytest.raises(BadInput) as refused:
        study(**shown)
    (line,) = refused.value.problems
    assert line.startswith(f"mine.yaml: architectures.networks-5.{next(iter(shown))}: ")
    assert expected in line


def test_the_darker_colour_that_a_refusal_names_is_taken():
    with pytest.raises(BadInput) as refused:
        study(colour="#FFB000")
    said = str(refused.value).split('white; "')[1][:7]
    assert study(colour=said).architectures["networks-5"].colour == said
    assert OF_LINES <= contrast(said) < OF_LINES + 0.2
