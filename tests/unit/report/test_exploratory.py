"""The verdicts on seeds that were seen before, beside those that count."""

import pytest

from tests.made_up import FROM, ONE, ZERO, N, made_up, part, share_of
from upswing.analysis.verdicts import write_verdicts
from upswing.cli.main import main
from upswing.report.exploratory import TABLE, exploratory, write_exploratory
from upswing.study.claims import Claim
from upswing.study.errors import BadInput


def judged(folder, share):
    asked = part("share", [ONE], where={"swing_ups": {"at_least": 1}}, **FROM)
    claims = {"C1": Claim(statement="…", section="…", cell=ONE, parts=[asked])}
    write_verdicts(made_up(folder, swing_ups=[share_of(share), ZERO, ZERO]), claims, {})


@pytest.mark.parametrize(
    ("share", "verdict", "estimate"),
    [
        (1, "reproduced", "1.000 [0.940, 1.000]"), (0.75, "at least partly", "0.750 [0.628, 0.842]"),
        (0.65, "partly", "0.650 [0.524, 0.758]"), (0, "not reproduced", "0.000 [0.000, 0.060]"),
    ],
)  # fmt: skip
def test_what_is_kept_is_shown(tmp_path, share, verdict, estimate):
    judged(tmp_path / "results", share)
    assert write_exploratory(tmp_path / "results", tmp_path) == tmp_path / TABLE
    row = {"claim": "C1", "verdict": verdict, "estimate": estimate, "n": str(N), "seeds": "0 to 59"}
    assert exploratory(tmp_path) == {"C1": row}


def test_without_it_nothing_is_shown(tmp_path):
    assert exploratory(tmp_path) == {}


def test_by_hand_it_is_kept_where_it_is_asked_for(tmp_path, capsys):
    judged(tmp_path / "results", 1)
    asked = ["exploratory", str(tmp_path / "results"), "--templates", str(tmp_path)]
    assert main(asked) == 0
    assert str(tmp_path / TABLE) in capsys.readouterr().out
    (tmp_path / "results/tables/verdicts.parquet").unlink()
    before = (tmp_path / TABLE).read_text("utf-8")
    with pytest.raises(BadInput, match=r"verdicts\.parquet: missing"):
        write_exploratory(tmp_path / "results", tmp_path)
    assert (tmp_path / TABLE).read_text("utf-8") == before
