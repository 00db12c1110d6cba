"""Which verdicts turn with another window, with half of the seeds, or with other readings."""

import numpy as np
import pandas as pd
import pytest

from tests.made_up import FROM, NOISE, ONE, OTHER, UP_TO, ZERO, N, made_up, part, share_of
from upswing.analysis.fragility import Seen, half, over_ending
from upswing.analysis.verdicts import OVER_READINGS, judge_all, write_verdicts
from upswing.runs.endings import ENDINGS, PERCENT
from upswing.runs.files.ledger import ledger_path, read_ledger
from upswing.runs.files.tables import read_verdicts
from upswing.study.claims import Claim

BALANCES = {"falls_last_fifth": {"at_most": 0}}
ALL, NONE, MOST = ([falls, ZERO, ZERO] for falls in (ZERO, ZERO + 3, 3 * (1 - share_of(58 / 60))))
"""Falls of the three cells: all runs of the first balance, none does, or all but one of each half."""


def claim_of(*parts):
    return {"C1": Claim(statement="…", section="…", cell=ONE, parts=parts)}


BALANCING = claim_of(part("share", [ONE], where=BALANCES, **FROM))


def endings_of(name, **columns):
    """The columns of a measure over every ending: as over the last fifth, but for those given."""
    return {ENDINGS[name].format(percent): columns.get(f"last_{percent}", columns["usual"])
            for percent in PERCENT}  # fmt: skip


def verdict(results, claims, over=None):
    (row,) = judge_all(results, claims, over or {})[0].to_dict("records")
    return row


def test_a_verdict_that_is_the_same_over_every_ending_and_in_every_half_is_not_fragile(tmp_path):
    columns = endings_of("falls_last_fifth", usual=MOST)
    found = verdict(made_up(tmp_path, falls_last_fifth=MOST, **columns), BALANCING)
    assert (found["verdict"], found["fragile"], found["fragile_because"]) == (
        "reproduced",
        False,
        "",
    )


@pytest.mark.parametrize("percent", PERCENT)
def test_a_verdict_that_turns_with_an_ending_says_with_which(tmp_path, percent):
    columns = endings_of("falls_last_fifth", usual=ALL, **{f"last_{percent}": NONE})
    found = verdict(made_up(tmp_path, falls_last_fifth=ALL, **columns), BALANCING)
    assert found["verdict"] == "reproduced"
    assert found["fragile"]
    assert found["fragile_because"] == f"over the last {percent} %: not reproduced"


@pytest.mark.parametrize("number", [0, 1])
def test_a_verdict_that_turns_in_half_of_the_seeds_says_so(tmp_path, number):
    """With 54 of 60 "reproduced" cannot be said; all six that fall have seeds of one half."""
    falls = np.zeros(N)
    falls[number : 12 + number : 2] = 3
    columns = endings_of("falls_last_fifth", usual=[falls, ZERO, ZERO])
    results = made_up(tmp_path, falls_last_fifth=[falls, ZERO, ZERO], **columns)
    found = verdict(results, BALANCING)
    assert found["verdict"] == "partly"
    steady = "the other half" if number == 0 else "one half of its seeds"
    assert found["fragile_because"] == f"{steady}: reproduced"
    # Whichever order the rows stand in.
    results.__dict__["runs"] = results.runs.iloc[::-1]
    assert verdict(results, BALANCING)["fragile_because"] == f"{steady}: reproduced"


def test_every_reason_is_named(tmp_path):
    falls = [share_of(0.5), ZERO, ZERO]
    columns = endings_of("falls_last_fifth", usual=falls, last_5=ALL, last_30=NONE)
    found = verdict(made_up(tmp_path, falls_last_fifth=falls, **columns), BALANCING)
    assert found["verdict"] == "inconclusive"
    expected = "over the last 5 %: reproduced; over the last 30 %: not reproduced"
    assert found["fragile_because"] == expected


def test_of_two_claims_each_has_its_own_reasons(tmp_path):
    columns = endings_of("falls_last_fifth", usual=[ZERO, ZERO, ZERO], last_5=NONE)
    results = made_up(tmp_path, falls_last_fifth=[ZERO, ZERO, ZERO], **columns)
    steady = Claim(statement="…", section="…", cell=OTHER,
                   parts=[part("share", [OTHER], where=BALANCES, **FROM)])  # fmt: skip
    verdicts, _ = judge_all(results, {**BALANCING, "C2": steady}, {})
    assert verdicts["fragile"].tolist() == [True, False]


@pytest.mark.parametrize("measure", ENDINGS)
def test_every_measure_of_an_ending_is_looked_at_over_other_endings(tmp_path, measure):
    """A mean that is near 1, and over the last tenth near 0."""
    values = {measure: [1 + NOISE / 100, ZERO, ZERO]}
    values |= endings_of(measure, usual=values[measure], last_10=[NOISE / 100, ZERO, ZERO])
    claims = claim_of(part("location", [ONE], measure=measure, **FROM))
    found = verdict(made_up(tmp_path, **values), claims)
    assert found["fragile_because"] == "over the last 10 %: not reproduced"


def test_runs_are_seen_over_another_ending_and_everything_usualis_as_it_was():
    names = {measure: name.format(5) for measure, name in ENDINGS.items()}
    runs = pd.DataFrame({"run": ["a", "b"], "seed": [0, 1], "falls": [9, 8]})
    for number, (measure, name) in enumerate(names.items()):
        runs[measure], runs[name] = [0, 0], [number, number + 1]
    runs["upright_last_5"] = [0.5, 0.25]
    seen = over_ending(5)(runs)
    for measure, name in names.items():
        assert seen[measure].tolist() == runs[name].tolist()
    others = [column for column in runs if column not in names]
    pd.testing.assert_frame_equal(seen[others], runs[others])
    # A table without endings, of a sweep, is seen as it is.
    bare = runs[["run", "seed", "falls_last_fifth"]]
    pd.testing.assert_frame_equal(over_ending(5)(bare), bare)


def test_the_halves_are_every_other_seed_and_make_up_the_whole():
    runs = pd.DataFrame({"seed": [5, 1, 4, 9, 3]})
    assert half(0)(runs)["seed"].tolist() == [1, 4, 9]
    assert half(1)(runs)["seed"].tolist() == [3, 5]


def test_what_is_seen_otherwise_leaves_out_what_diverged(tmp_path):
    diverged = np.where(np.arange(N) < 10, 7.0, np.nan)
    results = made_up(tmp_path, diverged_at=[diverged, ZERO * np.nan, ZERO * np.nan])
    assert len(Seen(results, half(0)).counted(ONE)) == 25
    assert len(Seen(results, half(0)).counted(OTHER)) == 30


# What the readings say makes a verdict fragile, too.


def over(weight, **more):
    row = dict.fromkeys(OVER_READINGS, weight) | {"grade": "depends on the reading"} | more
    return {"C1": row}


SAYS = "other readings, with {} of the weight, say otherwise"


@pytest.mark.parametrize(
    ("falls", "weight", "because"),
    [
        (ALL, 0.97, ""), (ALL, 0.949, SAYS.format("5%")), (ALL, 0.3, SAYS.format("70%")), (ALL, np.nan, ""),
        (NONE, 0.03, ""), (NONE, 0.3, SAYS.format("30%")), (NONE, 1.0, SAYS.format("100%")),
        ([share_of(0.3), ZERO, ZERO], 0.2, SAYS.format("20%")),
        ([share_of(0.5), ZERO, ZERO], 0.5, ""),
    ],
)  # fmt: skip
def test_a_twentieth_of_the_readings_weight_makes_a_verdict_fragile(
    tmp_path, falls, weight, because
):
    """What they say otherwise: against a claim that holds in full; for one that does partly, or not."""
    found = verdict(made_up(tmp_path, falls_last_fifth=falls), BALANCING, over(weight))
    assert found["fragile_because"] == because
    assert found["fragile"] == bool(because)


def test_a_verdict_has_beside_it_what_the_readings_say(tmp_path):
    said = over(0.97, held_share=0.9, weighted_low=0.93, weighted_high=0.99, grade="holds")
    results = made_up(tmp_path, falls_last_fifth=ALL)
    claims = {**BALANCING, "C2": BALANCING["C1"]}
    write_verdicts(results, claims, {name: row | {"readings": 324} for name, row in said.items()})
    first, second = read_verdicts(tmp_path).to_dict("records")
    assert {name: first[name] for name in OVER_READINGS} == said["C1"]
    assert all(pd.isna(second[name]) for name in OVER_READINGS)
    assert not second["fragile"]


def test_what_the_readings_said_is_kept_with_the_checksums(tmp_path):
    """So that whoever judges again, from the same, comes to the same."""
    kept = []
    for weight in (0.97, 0.96):
        write_verdicts(made_up(tmp_path, falls_last_fifth=ALL), BALANCING, over(weight))
        kept.append(read_ledger(ledger_path(tmp_path, "verdicts")).made_from["readings"])
    assert '"weighted_share": 0.97' in kept[0]
    assert kept[0] != kept[1]


def test_an_upper_threshold_turns_the_other_way(tmp_path):
    """Few runs balance: over the last 5 % all do."""
    claims = claim_of(part("share", [ONE], where=BALANCES, **UP_TO))
    columns = endings_of("falls_last_fifth", usual=NONE, last_5=ALL)
    found = verdict(made_up(tmp_path, falls_last_fifth=NONE, **columns), claims, over(0.99))
    assert found["verdict"] == "reproduced"
    assert found["fragile_because"] == "over the last 5 %: not reproduced"
