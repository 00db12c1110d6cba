"""Small things that the page is put together from: sentences, cards, the title, the citation."""

import pytest

from tests.paths import ROOT
from tests.unit.report.test_findings import cells
from upswing.report import words
from upswing.report.cards import cards
from upswing.report.citation import citation
from upswing.report.findings import findings
from upswing.report.headline import NEUTRAL, headline
from upswing.study.errors import BadInput


@pytest.mark.parametrize(
    ("says", "method", "expected"),
    [
        ("tables that stand at the end", "share, Wilson", "Share of tables that stand at the end"),
        ("of all, those that fall", "share, Wilson", "Of all, the share of those that fall"),
        ("pairs of runs in which one falls", "P(X > Y) over all pairs", "Share of pairs of runs in which one falls"),
        ("cost per step; it is better", "ratio of means, bootstrap", "Cost per step (“it is better”)"),
        ("tables; more steps do not help", "share, Wilson", "Share of tables (“more steps do not help”)"),
    ],
)  # fmt: skip
def test_what_is_measured_begins_a_sentence(says, method, expected):
    assert words.measured({"says": says, "method": method}) == expected
    assert words.measured({"measure": says, "method": method}) == expected


def test_an_estimate_says_what_it_counts():
    for measure, expected in (
        ("share_contracting", "problems"),
        ("share_represented", "starts"),
        ("falls_last_fifth ≥ 1", "runs"),
    ):
        assert words.unit({"measure": measure}) == expected


def test_a_claim_of_ones_own_holds_or_does_not_and_reproduces_nothing():
    def said(verdict, own, could_be_better=False):
        return words.verdict({"verdict": verdict, "could_be_better": could_be_better, "own": own})

    assert [said(word, own=True) for word in ("reproduced", "not reproduced", "inconclusive")] == [
        "holds", "does not hold", "inconclusive",
    ]  # fmt: skip
    assert said("not reproduced", own=False) == "not reproduced"
    assert {said("partly", own, could_be_better=True) for own in (True, False)} == {
        "at least partly"
    }


def test_rows_are_parted_where_a_column_changes():
    rows = [{"a": 1, "b": 1}, {"a": 1, "b": 2}, {"a": 2, "b": 2}, {"a": 1, "b": 1}]
    found = words.groups(rows, "a")
    assert [key for key, _ in found] == [(1,), (2,), (1,)]
    assert [row for _, own in found for row in own] == rows


def test_every_cell_of_a_card_knows_its_column():
    table = (
        '<table><thead><tr><th scope="col">a <em>b</em></th><th>c &lt; "d"</th></tr></thead>'
        '<tbody><tr><th colspan="2">group</th></tr><tr id="x"><th scope="row">1</th><td class="y">2</td></tr></tbody></table>'
    )
    made = cards(table)
    assert '<th scope="row" data-head="a b">1</th>' in made
    assert '<td class="y" data-head="c &lt; &quot;d&quot;">2</td>' in made
    assert '<th colspan="2">group</th>' in made
    assert made.count("data-head") == 2


def test_the_title_answers_only_where_the_tables_do():
    found = headline(cells(), findings(cells(), []), 14, 3_500)
    assert found.answer.startswith("Yes")
    assert "95 of 100" in found.description
    assert "3,500" in found.description
    for other in (cells(best=40), cells(best=60, thesis=58), {}):
        made = headline(other, findings(other, []), 14, 3_500)
        assert (made.question, made.answer) == (NEUTRAL, "")
        assert "Yes" not in made.description


def test_the_citation_is_that_of_the_project(tmp_path):
    found = citation(ROOT / "CITATION.cff")
    assert (found.license, found.version) == ("MIT", "0.1.0")
    assert f"year = {{{found.date[:4]}}}" in found.bibtex
    assert found.bibtex.count("{") == found.bibtex.count("}")
    assert citation(tmp_path / "none") is None
    (tmp_path / "one.cff").write_text(
        "title: x\nauthors: [{name: y}]\nversion: '1'\nlicense: MIT\n", "utf-8"
    )
    with pytest.raises(BadInput, match=r"one\.cff: date-released: missing"):
        citation(tmp_path / "one.cff")
