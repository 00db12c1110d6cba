"""The findings of the first screen: said where the tables bear them out, and not said where they do not."""

import pytest

from upswing.report.findings import FIGURE_8, LARGE, SMALL, findings


def cells(best=95, thesis=3, small=100, large=0):
    """Four cells of 100 runs."""
    full = {"runs": 100, "runs_without_fall_in_last_fifth": 0}
    balancing = {"runs": 100, "runs_upright_at_end": 0, "alpha": 1.0}
    return {
        "full-control/table/alpha-0.01": {**full, "alpha": 0.01, "runs_upright_at_end": best},
        FIGURE_8: {**full, "alpha": 0.001, "runs_upright_at_end": thesis},
        SMALL: {**balancing, "runs_without_fall_in_last_fifth": small},
        LARGE: {**balancing, "runs_without_fall_in_last_fifth": large},
    }


def verdict(claim, grade, share, cell="balancing/networks-5/alpha-1"):
    return {"claim": claim, "grade": grade, "weighted_share": share, "cells": cell}


def test_what_is_so_is_said_with_its_numbers():
    tables, small = findings(cells(), [])
    assert (tables.number, tables.claim) == ("95 of 100", "C8")
    assert "α = 0.01" in tables.says
    assert "3 of 100" in tables.says
    assert tables.certainty == "95 % interval of this share: 0.89 to 0.98"
    assert (small.number, small.claim) == ("100 of 100", "C3")


@pytest.mark.parametrize(
    "made",
    [
        cells(best=40, small=10),  # not most runs; no stable control
        cells(best=60, thesis=58, small=10),  # the step size makes no difference
        {},
        {SMALL: cells()[SMALL]},
    ],
)
def test_what_is_not_so_is_not_said(made):
    assert findings(made, []) == []


def test_networks_depend_where_a_grade_says_so():
    rows = [
        verdict("C5", "depends on the reading", 0.43),
        verdict("C13", "holds", 0.99, "full-control/modular-networks-5/alpha-1"),
        verdict("C7", "depends on the reading", 0.5, FIGURE_8),
        verdict("C14", None, float("nan")),
    ]
    (found,) = findings({}, rows)
    assert (found.number, found.claim, found.certainty) == (
        "1 of 2",
        "C5",
        "Probabilities over readings: C5 0.43",
    )
    assert findings({}, rows[1:]) == []
