"""Figures of a study's own: of panels, of a file, and whose code is run by what."""

import json

import pytest

from tests.made_up import ONE, OTHER, STUDY, THIRD, made_up
from upswing import figures
from upswing.report.interactive import shown_figures
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.study.claims import Claims
from upswing.study.config import validated
from upswing.study.errors import BadInput

PANELS = [
    {"panel": "measure", "measure": "falls", "cells": [ONE, THIRD], "title": "Its title"},
    {"panel": "step-sizes", "cells": [ONE, OTHER, THIRD]},
]
CLAIM = {
    "statement": "It falls.",
    "figure": "mine",
    "parts": [
        {"says": "runs fall", "kind": "share", "cells": [ONE], "because": "so many",
         "where": {"falls": {"at_least": 1}}, "at_least": 0.8, "partly": 0.5}
    ],
}  # fmt: skip
CODE = """
from upswing.figures.declaration import Declaration

FIGURE = Declaration("A file's", "", ())


def draw({}):
    from upswing.figures.panels import Drawing
    from upswing.figures.style import subplots

    return Drawing(subplots(1, 1)[0], f"{{{}}}", [])
"""
CLAIMS = Claims.model_validate({"S1": CLAIM, "S2": {**CLAIM, "figure": 6}}).root


def results(folder, *own, **architecture):
    """Made-up runs of a study with figures of its own."""
    found = made_up(folder)
    table = {"learner": "table", **architecture}
    study = validated({"mine": {**STUDY, "architectures": {"table": table}, "figures": list(own)}})
    write_study(canonical(study), folder)
    return Results(found.folder)


def words_of(folder, name="mine"):
    return json.loads((folder / f"figures/{name}.json").read_text("utf-8"))


def test_panels_are_drawn_with_what_decides_the_claims_that_name_the_figure(tmp_path):
    own = {"name": "mine", "title": "Mine", "panels": PANELS, "caption": "Look here."}
    figures.draw("mine", results(tmp_path, own, colour="#7A2048", label="a table"), CLAIMS)
    words = words_of(tmp_path)
    assert words["claims"] == ["S1"]
    assert words["caption"].startswith("Look here. ")
    assert "what decides S1" in words["caption"]
    assert words["alt"] == "Mine. Look here."
    measured, decided = words["panels"]
    assert [runs["cell"] for runs in measured["runs"]] == [ONE, THIRD]
    assert [runs["cell"] for runs in decided["runs"]] == [ONE]
    picture = (tmp_path / "figures/mine.svg").read_text("utf-8")
    assert "Its title" in picture
    assert "a table, α = 0.1" in picture
    assert "#7a2048" in picture
    assert "#0072b2" not in picture.lower()


def test_without_claims_nothing_is_decided(tmp_path):
    own = {"name": "mine", "title": "Mine", "panels": PANELS[:1]}
    figures.draw("mine", results(tmp_path, own), {})
    assert words_of(tmp_path)["claims"] == []
    assert "decides" not in words_of(tmp_path)["caption"]


def file_of(folder, given="results", said="len(results.cells)"):
    path = folder / "figures/mine.py"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(CODE.format(given, said), "utf-8")
    return {"name": "mine", "file": str(path)}


@pytest.mark.parametrize(
    ("given", "said", "caption"),
    [("results", "len(results.cells)", "3"), ("results, claims", "list(claims)", "['S1']")],
)
def test_a_file_is_given_the_results_and_if_it_wants_them_its_claims(
    tmp_path, given, said, caption
):
    found = results(tmp_path / "results", file_of(tmp_path / "config", given, said))
    figures.draw("mine", found, CLAIMS)
    words = words_of(tmp_path / "results")
    assert (words["title"], words["caption"], words["claims"]) == ("A file's", caption, ["S1"])


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "FIGURE: must be a Declaration"),
        (CODE.partition("def draw")[0], "draw: missing"),
        (CODE.format("results", "1").partition("    from")[0] + "    return 3", "must return a panels.Drawing"),
        ("def (", "line 1: SyntaxError"),
        ("import nothing_of_this_name", "line 1: ModuleNotFoundError"),
    ],
)  # fmt: skip
def test_a_file_that_is_no_figure_is_refused(tmp_path, text, expected):
    own = file_of(tmp_path / "config")
    (tmp_path / "config/figures/mine.py").write_text(text, "utf-8")
    with pytest.raises(BadInput, match=r"figures/mine\.py: ") as refused:
        figures.draw("mine", results(tmp_path / "results", own), {})
    assert expected in str(refused.value)


def test_no_code_is_run_from_a_folder_of_results(tmp_path):
    own = file_of(tmp_path / "results")
    with pytest.raises(BadInput, match="is no code to run"):
        figures.draw("mine", results(tmp_path / "results", own), {})


def test_the_page_runs_no_code_and_shows_what_was_drawn(tmp_path):
    own = file_of(tmp_path / "config")
    found = results(tmp_path / "results", own)
    (shown,) = (one for one in shown_figures(found.folder) if one["name"] == "mine")
    assert (shown["missing"], shown["title"]) == (True, "mine")
    figures.draw("mine", found, CLAIMS)
    (tmp_path / "config/figures/mine.py").write_text("raise SystemExit(3)", "utf-8")
    (shown,) = (one for one in shown_figures(found.folder) if one["name"] == "mine")
    assert (shown["missing"], shown["title"], shown["claims"]) == (False, "A file's", ["S1"])


def test_a_figure_that_a_study_does_not_have_is_refused(tmp_path):
    with pytest.raises(BadInput, match="no such figure"):
        figures.draw("mine", results(tmp_path), {})
