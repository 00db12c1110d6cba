"""The page of a study of one's own: it speaks of that study, and of nothing that it has not."""

import re
from copy import deepcopy
from functools import cache
from pathlib import Path

import pytest

from tests.paths import ROOT
from tests.unit.report.small_pages import page_of_small
from tests.unit.report.test_pendulums import study_of, text_of
from upswing.physics.braking import highest_stoppable_speed
from upswing.physics.pendulum import Pendulum
from upswing.report.command import Configuration, commands, configuration_of
from upswing.report.glossary import glossary
from upswing.report.own import counted, is_own, own_words, shown_verdicts, title_of
from upswing.report.pendulums import length_of_a_step, lengths, pendulums
from upswing.study.config import load, narrowed, validated
from upswing.study.matrix import Matrix

STRONG = {"length": 0.4, "accelerations": [-20, -10, 0, 10, 20]}
OWN = {
    "results": "results/strong",
    "seeds": 2,
    "tasks": {
        "full-control": {
            "kind": "full-control",
            "steps": 6_000,
        },  # as if inherited: nothing names it
        "swing-up": {"kind": "full-control", "steps": 6_000, "pendulum": STRONG},
    },
    "architectures": {
        "table": {"learner": "table"},
        "networks-5": {"learner": "networks", "hidden": [5]},
    },
    "experiments": [{"tasks": ["swing-up"], "architectures": ["table"], "alphas": [0.1, 0.01]}],
}
SEVERAL = {
    **deepcopy(OWN),
    "title": "Which cart is strong enough?",
    "about": "Two carts.",
    "tasks": {
        "weak": {"kind": "full-control", "steps": 6_000},
        "strong": {"kind": "full-control", "steps": 6_000, "pendulum": {"accelerations": [-20, 0, 20]}},
    },
    "experiments": [{"tasks": ["weak", "strong"], "architectures": ["table"], "alphas": [0.01]}],
    "figures": ["pendulums"],
}  # fmt: skip
SMOKE = {
    **deepcopy(OWN),
    "judges": False,
    "tasks": {"balancing": {"kind": "balancing", "steps": 6_000}},
    "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1, 0.001]}],
}


STUDIES = {"own": OWN, "several": SEVERAL, "smoke": SMOKE}


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """The pages of these studies, each made when it is first asked for."""
    return cache(lambda name: page_of_small(STUDIES[name], tmp_path_factory.mktemp(name)))


@pytest.fixture(params=STUDIES)
def page(request, pages):
    """One of the studies, and its page."""
    return STUDIES[request.param], pages(request.param)


OF_CLAIMS = (
    "not in this study", "would change", "The verdicts", "If you are the author", "over readings",
    "registered on", "make reproduce", "The evidence for", "claims of",
    "upswing verdicts", "not drawn", "fragile", "C16", "make bench",
)  # fmt: skip


def test_it_says_nothing_of_claims_that_it_does_not_judge(page):
    content, html = page
    said = text_of(re.sub(r"<(style|script).*?</\1>", " ", html, flags=re.DOTALL))
    for words in OF_CLAIMS:
        assert words not in said, words
    assert "--results results/strong" in said
    assert "Besides: " in said.split("Deviations from the thesis")[-1]
    assert "the three controls are ours" not in said
    assert f"<h1>{title_of(validated({'study': content}))}</h1>" in html
    assert not re.search(r"\{%|%\}", said)


def test_every_link_within_it_leads_somewhere(page):
    _, html = page
    ids = set(re.findall(r'\bid="([^"]+)"', html))
    assert set(re.findall(r'href="#([^"]+)"', html)) <= ids


def test_what_came_out_is_a_row_for_each_setting_unless_nothing_is_judged(page):
    content, html = page
    table = re.findall(r'aria-label="What came out".*?</table>', html, re.DOTALL)
    if not content.get("judges", True):
        assert table == []
        assert "This page judges nothing" in html
        assert "4 runs, 2 of each of 2 settings, which is too little" in text_of(html)
        assert "Below, what decides" not in html
        return
    assert table[0].count("<tr>") == 1 + len(Matrix(validated({"study": content})).cells)
    assert "This page judges nothing" not in html


def test_its_pendulum_is_its_own_and_no_inherited_task_is_in_it(pages):
    study = validated({"study": OWN})
    assert list(narrowed(study).tasks) == ["swing-up"]
    assert list(narrowed(study).architectures) == ["table"]
    said = text_of(pages("own"))
    (one,) = pendulums(narrowed(study))
    speed = highest_stoppable_speed(Pendulum(length=0.4, accelerations=(-20, -10, 0, 10, 20)))
    assert one.stoppable == speed
    assert f"faster than {speed:.2f} rad/s" in said
    assert "one of five actions" in said
    assert "90 % of its last 1,200 steps" in said
    assert "networks-5" not in said
    assert "balancing" not in said.replace("without a fall when balancing", "")


def test_the_figure_over_pendulums_says_what_can_be_stopped(pages):
    html = pages("several")
    assert "Two carts." in html
    said = text_of(html)
    assert (
        "What to see: what can be stopped goes from 20.2 rad/s at 10 m/s² to 26.6 rad/s at 20 m/s²"
        in said
    )
    assert "What the step size decides" not in said  # each architecture has one


@pytest.mark.parametrize(
    ("results", "make", "folder"),
    [
        ("results", "make reproduce", ""),
        ("results/smoke", "make smoke", " --results results/smoke"),
        ("results/poles", "make study CONFIG=config/poles.yaml", " --results results/poles"),
        ("else where", "make study CONFIG=CONFIG.yaml", " --results 'else where'"),
    ],
)
def test_commands_are_those_of_the_study(results, make, folder):
    study = validated({"study": {**OWN, "results": results}})
    found = commands(study, Path("config"))
    assert (found.make, found.folder) == (make, folder)
    assert (found.browse == "make browse") == (results == "results")


def test_a_configuration_is_found_by_its_folder_among_others_that_are_none(tmp_path):
    (tmp_path / "a.yaml").write_text("nonsense: [", "utf-8")
    (tmp_path / "claims.yaml").write_text("C1: {}", "utf-8")
    assert configuration_of(validated({"study": OWN}), tmp_path) is None
    text = (
        (ROOT / "config/smoke.yaml").read_text("utf-8").replace("results/smoke", "results/strong")
    )
    (tmp_path / "mine.yaml").write_text(text, "utf-8")
    found = configuration_of(validated({"study": OWN}), tmp_path)
    assert found == Configuration(tmp_path / "mine.yaml", elsewhere=False)


@pytest.mark.parametrize(
    ("file", "folder", "with_make", "without"),
    [
        ("config.yaml", "mine", "make reproduce RESULTS=mine", "snakemake --cores all --config results=mine"),
        ("smoke.yaml", "mine/smoke", "make smoke RESULTS=mine",
         "snakemake --cores all --configfile config/smoke.yaml --config results=mine/smoke"),
        ("beyond.yaml", "my own/beyond", "make beyond RESULTS='my own'",
         "snakemake --cores all --configfile config/beyond.yaml --config results='my own/beyond'"),
        ("poles.yaml", "mine", "make study CONFIG=config/poles.yaml RESULTS=mine",
         "snakemake --cores all --configfile config/poles.yaml --config results=mine"),
        ("poles.yaml", "results/poles", "make study CONFIG=config/poles.yaml",
         "snakemake --cores all --configfile config/poles.yaml"),
        ("config.yaml", "results", "make reproduce", "snakemake --cores all"),
    ],
)  # fmt: skip
def test_results_elsewhere_are_in_the_command_and_so_is_a_folder_without_a_makefile(
    file, folder, with_make, without, tmp_path
):
    study = load(Path("config") / file).model_copy(update={"results": folder})
    here = commands(study, Path("config"))
    assert (here.make, here.upswing) == (with_make, ".venv/bin/upswing")
    there = commands(study, Path("config"), tmp_path / "Makefile")
    assert (there.make, there.upswing) == (without, "upswing")
    assert there.browse.startswith("upswing browse")
    assert ("--config results=" in there.snakemake) == ("--config results=" in without)


def row(claim, verdict, cells):
    return {"claim": claim, "verdict": verdict, "cells": cells}


def test_verdicts_are_shown_where_a_cell_is_judged_and_the_study_judges():
    own = validated({"study": OWN})
    theorem, missing = row("C16", "reproduced", ""), row("C1", "not in this study", "a/b/alpha-1")
    judged = row("C2", "inconclusive", "a/b/alpha-1")
    assert shown_verdicts([theorem, missing], own) == []
    assert shown_verdicts([theorem, missing, judged], own) == [theorem, missing, judged]
    assert shown_verdicts([theorem, judged], validated({"study": {**OWN, "judges": False}})) == []
    assert (is_own(own, []), is_own(own, [judged])) == (True, False)
    assert is_own(validated({"study": {**OWN, "title": "What?"}}), [judged])
    assert not is_own(load(Path("config/beyond.yaml")), [])  # the thesis's chapter


def test_a_study_with_claims_of_its_own_is_ones_own():
    thesis = load(ROOT / "config/config.yaml")
    verdicts = [row("P1", "reproduced", "full-control/table/alpha-0.01")]
    assert not is_own(thesis, verdicts)
    assert is_own(thesis.model_copy(update={"claims": "config/mine.yaml"}), verdicts)


def test_a_title_is_made_of_what_learns_at_what():
    assert title_of(validated({"study": OWN})) == "Table at swing-up"
    assert (
        title_of(load(Path("config/config.yaml")))
        == "6 architectures at balancing, full-control and full-control-long"
    )
    assert counted(1, 5, "5") == "5 runs, 5 of one setting"
    assert counted(4, 1_200, "50 to 300") == "1,200 runs, 50 to 300 of each of 4 settings"


def test_words_have_the_lengths_of_the_study():
    words = glossary(Path("report"))
    slow = study_of(slow={"pendulum": {"time_step": 0.01}}, plain={})
    own = own_words(words, slow, lengths(slow), length_of_a_step(slow), judged=False)
    assert own["step"].meaning.startswith("5 or 10 ms of the pendulum’s time.")
    assert own["stands"].meaning.endswith("90 % of its last 500 s.")
    assert own["stable"].meaning.startswith("25 s without a fall")
    assert not {"fragile", "check", "over-readings", "balancing", "control"} & own.keys()
    thesis = load(Path("config/config.yaml"))
    same = own_words(words, thesis, lengths(thesis), length_of_a_step(thesis), judged=False)
    judging = own_words(words, thesis, lengths(thesis), length_of_a_step(thesis), judged=True)
    assert set(judging) - set(same) == {"at-least-partly", "at-threshold", "fragile", "check"}
    changed = [key for key, word in same.items() if word != words[key]]
    assert changed == ["diverged"]
    assert {"balancing", "control", "stands"} <= same.keys()
