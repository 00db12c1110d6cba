"""What the project brings along of its readings, for a study that has not swept them."""

import json
from pathlib import Path

import pandas as pd
import pytest

from tests.made_up import FROM, ONE, ZERO, made_up, part, share_of
from upswing.analysis.robustness.judging import sweep_of
from upswing.analysis.robustness.shipped import (
    checksum_of,
    over_readings,
    read_shipped,
    write_shipped,
)
from upswing.analysis.robustness.tables import SHIPPED
from upswing.analysis.verdicts import write_verdicts
from upswing.runs.files.tables import write_table
from upswing.study.claims import Claim, load_claims
from upswing.study.config import load
from upswing.study.errors import BadInput
from upswing.study.paths import ROBUST
from upswing.study.registration import of
from upswing.study.sweeps import load_sweeps

BALANCES = {"swing_ups": {"at_least": 1}}


def claim(**settings):
    parts = [part("share", [ONE], where=BALANCES, **{**FROM, **settings})]
    return Claim(statement="…", section="…", cell=ONE, parts=parts)


CLAIMS = {"C1": claim(), "C2": claim(partly=0.4)}


def row_of(name, share, grade):
    return {
        "claim": name, "sweep": "networks", "readings": 324, "holds": 9, "estimate_holds": 11,
        "default": "partly", "reproduced": 1, "partly": 8, "inconclusive": 300, "not reproduced": 15,
        "held_share": 1 / 3, "weighted_share": share, "weighted_low": share - 0.01,
        "weighted_high": share + 0.01, "grade": grade, "left_out": "p7", "by_prior": "even in log η: 0.91",
    }  # fmt: skip


ROWS = [row_of("C1", 0.912345678, "depends on the reading"), row_of("C2", 0.98, "holds")]


@pytest.fixture
def folders(tmp_path):
    """Results in which readings were swept, others in which they were not, and templates."""
    swept, other, templates = (tmp_path / name for name in ("swept", "other", "templates"))
    for folder in (swept / "tables", other / "tables", templates):
        folder.mkdir(parents=True)
    write_table(swept / ROBUST, pd.DataFrame(ROWS))
    return swept, other, templates


def test_what_is_shipped_is_what_the_sweeps_came_to(folders):
    swept, other, templates = folders
    write_shipped(swept, templates, CLAIMS, {"sweeps": "abc"})
    found, source = over_readings(other, templates, CLAIMS)
    assert source == "shipped"
    for row in ROWS:
        shipped = found[row["claim"]]
        assert shipped.pop("judged") == checksum_of(CLAIMS[row["claim"]])
        assert shipped == {
            name: pytest.approx(value, abs=5e-5) if isinstance(value, float) else value
            for name, value in row.items()
        }
    content = json.loads((templates / SHIPPED).read_text("utf-8"))
    assert content["made_from"]["sweeps"] == "abc"
    assert content["made_from"]["commit"]


def test_a_difference_in_the_last_digits_is_none(folders):
    swept, _, templates = folders
    write_shipped(swept, templates, CLAIMS, {})
    before = (templates / SHIPPED).read_bytes()
    write_table(swept / ROBUST, pd.DataFrame(ROWS).assign(weighted_low=lambda t: t["weighted_low"] + 1e-9))  # fmt: skip
    write_shipped(swept, templates, CLAIMS, {})
    assert (templates / SHIPPED).read_bytes() == before


@pytest.mark.parametrize(
    "changed",
    [claim(at_least=0.81), claim(partly=0.6), claim(among={"falls": {"at_least": 1}}), claim(fewest=2)],
)  # fmt: skip
def test_a_claim_that_has_been_changed_takes_nothing(folders, changed):
    swept, other, templates = folders
    write_shipped(swept, templates, CLAIMS, {})
    found, source = over_readings(other, templates, {**CLAIMS, "C1": changed})
    assert (list(found), source) == (["C2"], "shipped")


def test_claims_that_are_not_asked_about_are_left_out(folders):
    swept, other, templates = folders
    write_shipped(swept, templates, {"C2": CLAIMS["C2"]}, {})
    assert list(over_readings(other, templates, CLAIMS)[0]) == ["C2"]
    write_shipped(swept, templates, CLAIMS, {})
    assert list(over_readings(other, templates, {"C1": CLAIMS["C1"]})[0]) == ["C1"]


def test_an_own_table_wins(folders):
    """Even over what says more, and for a claim that has been changed since the other."""
    swept, other, templates = folders
    write_shipped(swept, templates, CLAIMS, {})
    own = row_of("C1", 0.25, "depends on the reading")
    write_table(other / ROBUST, pd.DataFrame([own]))
    found, source = over_readings(other, templates, {"C1": claim(at_least=0.81)})
    assert source == "own"
    assert found == {"C1": own}


def test_without_either_nothing_is_said(folders):
    _, other, templates = folders
    assert over_readings(other, templates, CLAIMS) == ({}, "")


@pytest.mark.parametrize("text", ["", "{", "[]", "{}", '{"claims": []}', '{"claims": {"C1": {}}}', '{"claims": {"C1": 3}}'])  # fmt: skip
def test_what_is_not_what_was_shipped_is_named(folders, text):
    _, other, templates = folders
    (templates / SHIPPED).write_text(text, "utf-8")
    with pytest.raises(BadInput, match=f"{SHIPPED}: is not what `make readme` writes"):
        over_readings(other, templates, CLAIMS)


def test_an_own_table_of_another_kind_is_named(folders):
    _, other, templates = folders
    write_table(other / ROBUST, pd.DataFrame({"claim": ["C1"]}))
    with pytest.raises(BadInput, match=r"robust\.parquet: is no such table"):
        over_readings(other, templates, CLAIMS)


def test_verdicts_take_what_is_shipped(folders):
    """The one claim's readings say otherwise with 9 % of their weight, the other's with 2 %."""
    swept, other, templates = folders
    write_shipped(swept, templates, CLAIMS, {})
    over, _ = over_readings(other, templates, CLAIMS)
    results = made_up(other, swing_ups=[share_of(1), ZERO, ZERO])
    verdicts = write_verdicts(results, CLAIMS, over).set_index("claim")
    assert verdicts["grade"].tolist() == ["depends on the reading", "holds"]
    assert verdicts["fragile"].tolist() == [True, False]
    assert "9% of the weight" in verdicts.at["C1", "fragile_because"]


def test_what_the_project_brings_along_is_of_its_own_claims_and_sweeps():
    """After a change of a claim, `make readings` and `make readme` are due."""
    study = load(Path("config/config.yaml"))
    claims = load_claims(Path("config/claims.yaml"), study)
    sweeps = load_sweeps(Path("config/readings.yaml"), study)
    found = read_shipped(Path("report"))
    swept = {name for name, claim in claims.items() if sweep_of(claim, sweeps, study)}
    assert found.claims.keys() == swept == claims.keys() - {"C16"}
    for name, row in found.claims.items():
        assert row["judged"] == checksum_of(claims[name]), name
        assert 0 <= row["weighted_low"] <= row["weighted_share"] <= row["weighted_high"] <= 1
    assert found.made_from["sweeps"] == of(study, claims, sweeps).sweeps
