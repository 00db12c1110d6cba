"""The colours and labels of architectures: those that are said, and one of its own for each other."""

from itertools import combinations, pairwise

import pytest

from upswing.analysis.colours import (
    COLOURS,
    OF_LINES,
    OF_TEXT,
    OTHERS,
    colour,
    contrast,
    label,
    of_text,
    shown_as,
    shown_of,
)
from upswing.study.config import validated
from upswing.study.contrast import distance

CELL = "balancing/{}/alpha-0.1"


def study(**architectures):
    every = {
        name.replace("_", "-"): {"learner": "table", **own} for name, own in architectures.items()
    }
    return validated({"mine.yaml": {
        "seeds": 2,
        "tasks": {"balancing": {"kind": "balancing", "steps": 500}},
        "architectures": every,
        "experiments": [{"tasks": ["balancing"], "architectures": list(every), "alphas": [0.1]}],
    }})  # fmt: skip


def many(number):
    return study(**{f"own_{at}": {} for at in range(number)})


def test_every_colour_can_be_seen_and_read_as_text():
    for shade in (*COLOURS.values(), *OTHERS):
        assert contrast(shade) >= OF_LINES
        assert contrast(of_text(shade)) >= OF_TEXT


def test_colours_are_as_far_apart_as_the_closest_of_the_thesis_or_nearly():
    least = min(distance(*pair) for pair in combinations(COLOURS.values(), 2))
    every = (*COLOURS.values(), *OTHERS, "#000000")
    assert min(distance(*pair) for pair in combinations(every, 2)) > 0.8 * least


def test_distance_is_that_of_oklab():
    assert distance("#000000", "#FFFFFF") == pytest.approx(1, abs=1e-6)
    assert distance("#FF0000", "#FF0000") == 0
    assert distance("#FF0000", "#00FF00") == pytest.approx(0.5197, abs=1e-3)


def test_architectures_that_nobody_named_a_colour_for_have_one_each():
    found = [one.colour for one in shown_of(many(len(OTHERS))).values()]
    assert sorted(found) == sorted(OTHERS)
    shades = [one.colour for one in shown_of(many(len(OTHERS) + 5)).values()]
    assert set(shades) == set(OTHERS)  # of more than there are, some share one


def test_a_colour_follows_from_the_name_and_one_more_changes_none():
    for fewer, more in pairwise(shown_of(many(number)) for number in range(1, 12)):
        assert more.items() >= fewer.items()
    alone = shown_of(study(mine={}))["mine"]
    assert alone == shown_of(study(table={}, another={"colour": "#000000"}, mine={}))["mine"]
    assert colour(CELL.format("mine")) == alone.colour  # also where no study is known


def test_no_own_colour_is_close_to_one_that_the_study_names():
    for taken in OTHERS:
        found = shown_of(study(**{f"own_{at}": {} for at in range(5)}, said={"colour": taken}))
        others = [one.colour for name, one in found.items() if name != "said"]
        assert min(distance(taken, other) for other in others) >= 0.08


def test_what_a_study_says_is_shown_while_it_is_shown():
    said = study(table={"colour": "#7A2048", "label": "a table"}, mine={})
    before = colour(CELL.format("table")), label(CELL.format("table"))
    with shown_as(said, ["adopted"]):
        assert colour(CELL.format("table")) == "#7A2048"
        assert label(CELL.format("table")) == "a table, α = 0.1"
        assert label("balancing/adopted/alpha-none") == "adopted"
        assert len({colour(CELL.format(name)) for name in ("table", "mine", "adopted")}) == 3
    assert (colour(CELL.format("table")), label(CELL.format("table"))) == before
    assert before == (COLOURS["table"], "table, α = 0.1")
