"""What jobs need: more than was measured, more for longer runs, and more at a further attempt."""

import pytest

from tests.helpers import make_spec
from tests.paths import ROOT
from upswing.runs import needs
from upswing.runs.outlook import usual
from upswing.study.config import load


@pytest.mark.parametrize("rule", sorted(needs.MEASURED))
def test_a_rule_has_more_than_was_measured(rule):
    megabytes, seconds = needs.MEASURED[rule]
    memory, minutes = needs.memory(rule), needs.minutes(rule)
    assert megabytes < memory(None, 1) < 8 * max(megabytes, needs.LEAST_MEMORY)
    assert seconds < 60 * minutes(None, 1)
    assert [memory(None, n) for n in (1, 2, 3)] == [n * memory(None, 1) for n in (1, 2, 3)]
    assert minutes(None, 2) == 2 * minutes(None, 1)


def test_longer_runs_and_more_of_them_have_more():
    short, long = (make_spec(steps=steps, seeds=tuple(range(50))) for steps in (50_000, 5_000_000))
    assert needs.memory_of_training(50_000) < needs.memory_of_training(5_000_000)
    assert needs.minutes_of_training(long) > needs.minutes_of_training(short)
    assert usual(long, 50) < 60 * needs.minutes_of_training(long)


def test_a_search_has_what_all_its_candidates_take():
    beyond, thesis = (load(ROOT / f"config/{name}.yaml") for name in ("beyond", "config"))
    assert needs.needs_of_search(thesis) == (needs.LEAST_MEMORY, needs.LEAST_MINUTES)
    memory, minutes = needs.needs_of_search(beyond)
    assert memory == needs.memory_of_training(max(beyond.search.lengths))
    one_of_many = make_spec(steps=max(beyond.search.lengths), seeds=beyond.search.seeds)
    assert 60 * minutes > 10 * usual(one_of_many, len(one_of_many.seeds))
