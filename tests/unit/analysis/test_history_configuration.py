"""How configurations differ, key by key."""

import pytest
import yaml

from tests.paths import ROOT
from upswing.analysis.history.configuration import differences, text_of
from upswing.study.config import validated
from upswing.study.sweeps import load_sweeps  # noqa: F401  what a study is checked with


def plain(**changes):
    """The thesis's study with changes, as plain values."""
    content = yaml.safe_load((ROOT / "config/config.yaml").read_text("utf-8"))
    return validated({"study": {**content, **changes}}).model_dump(mode="json")


BASE = yaml.safe_load((ROOT / "config/config.yaml").read_text("utf-8"))


def changed(*configurations):
    return [(row.key, *row.values) for row in differences(configurations)]


def test_the_same_has_no_difference():
    assert changed(plain(), plain()) == []
    assert changed(plain(), plain(), plain()) == []


def test_a_key_is_named_with_its_values_before_and_after():
    assert changed(plain(), plain(epsilon=0.02)) == [("epsilon", "0.01", "0.02")]
    reading = changed(plain(), plain(readings={"reset": "terminal"}))
    assert reading == [("readings.reset", "fallen", "terminal")]
    assert changed(plain(), plain(epsilon=0.02), plain()) == [("epsilon", "0.01", "0.02", "0.01")]


def test_seeds_are_written_short():
    (row,) = changed(plain(), plain(seeds={"first": 10000, "count": 60}))
    assert row == ("seeds", "10000 to 10049 (50)", "10000 to 10059 (60)")
    assert text_of([1, 2, 3, 7, 8]) == "1 to 3, 7 to 8 (5)"
    assert text_of([5, 3, 1, 7]) == "[5, 3, 1, 7]"


def test_an_experiment_in_between_changes_no_other():
    new = {"tasks": ["balancing"], "architectures": ["networks-30"], "alphas": [0.5]}
    experiments = BASE["experiments"]
    with_one = plain(experiments=[experiments[0], new, *experiments[1:]])
    (row,) = changed(plain(), with_one)
    assert row[0] == "experiments[balancing: networks-30]"
    assert row[1] == "–"
    assert "alphas: [0.5]" in row[2]


def test_an_alpha_that_is_added_is_named_with_what_it_is_added_to():
    experiments = [dict(one) for one in BASE["experiments"]]
    experiments[0]["alphas"] = [1, 0.61, *experiments[0]["alphas"][1:]]
    (row,) = changed(plain(), plain(experiments=experiments))
    assert row[0] == "experiments[balancing: table].alphas"
    assert row[1:] == ("[1, 0.75, 0.5, 0.1, 0.01, 0.001]", "[1, 0.61, 0.75, 0.5, 0.1, 0.01, 0.001]")


def test_an_architecture_that_is_added_to_an_experiment_is_a_change_of_it():
    experiments = [
        {"tasks": ["balancing"], "architectures": ["idle"]},
        {"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]},
    ]
    wider = [{**experiments[0], "architectures": ["idle", "random"]}, experiments[1]]
    (row,) = changed(plain(experiments=experiments), plain(experiments=wider))
    assert row == ("experiments[balancing: idle].architectures", "[idle]", "[idle, random]")


def test_another_order_is_said_once():
    (row,) = changed(plain(), plain(experiments=BASE["experiments"][::-1]))
    assert row == ("experiments (their order)", "the first order", "another order")


def test_what_only_one_side_has_is_one_line():
    more = {**BASE["architectures"], "networks-10": {"learner": "networks", "hidden": [10]}}
    (row,) = changed(plain(), plain(architectures=more))
    assert row[:2] == ("architectures.networks-10", "–")
    assert row[2].startswith("{learner: networks, ")
    assert row[2].endswith("hidden: [10]}")


@pytest.mark.parametrize("value", [0, 0.0, None, "", False, [], {}])
def test_any_value_has_a_text(value):
    assert text_of(value)
    assert changed({"a": 1}, {"a": value}) == [("a", "1", text_of(value))]
    assert changed({}, {"a": value}) == [("a", "–", text_of(value))]


def test_a_long_value_is_cut():
    assert len(text_of(["x" * 50] * 10)) == 160
