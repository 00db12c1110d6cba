"""The ready studies: the gallery names each of them as it is, and each ends in its page."""

import re

import pytest

from tests.paths import ROOT
from tests.unit.report.small_pages import page_of_small
from tests.unit.report.test_pendulums import text_of
from upswing.study.config import Study, load
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix

GALLERY = (ROOT / "docs/gallery.md").read_text("utf-8")


def studies() -> dict[str, Study]:
    """Every study in the folder of configurations, by the name of its file."""
    found = {}
    for path in sorted((ROOT / "config").glob("*.yaml")):
        try:
            found[path.name] = load(path)
        except BadInput:  # claims, readings, what was registered
            continue
    return found


STUDIES = studies()
SMALL = [name for name in STUDIES if name not in ("config.yaml", "beyond.yaml")]


def test_the_gallery_has_every_study_with_its_runs_and_its_question():
    rows = re.findall(r"^\| \[`(\S+)`\]\(#\S+\) \| (.+?) \| ([\d,]+) \|", GALLERY, re.MULTILINE)
    assert sorted(name for name, *_ in rows) == sorted(STUDIES)
    for name, question, runs in rows:
        study = STUDIES[name]
        assert int(runs.replace(",", "")) == len(list(Matrix(study).runs)), name
        if study.title and name not in ("smoke.yaml", "template.yaml"):
            assert question == study.title


def test_each_study_has_a_folder_of_its_own():
    folders = [study.results for study in STUDIES.values()]
    assert len(set(folders)) == len(folders)


def tiny(study: Study) -> dict:
    """The same study with two seeds and no more than a few thousand steps a run."""
    content = study.model_dump(mode="json", exclude={"search"})
    content["seeds"] = [0, 1]
    for one in content["experiments"]:
        one["seeds"] = None
    longest = max(task["steps"] for task in content["tasks"].values())
    for task in content["tasks"].values():
        task["steps"] = max(2_000, task["steps"] * 4_000 // longest)
    return content


@pytest.mark.heavy
@pytest.mark.parametrize("name", SMALL)
def test_each_ends_in_its_page(name, tmp_path):
    study = STUDIES[name]
    html = page_of_small(tiny(study), tmp_path)
    said = text_of(re.sub(r"<(style|script).*?</\1>", " ", html, flags=re.DOTALL))
    assert f"<h1>{study.title}</h1>" in html.replace("&#39;", "'")
    assert study.about.strip() in said.replace("&#39;", "'")
    assert "not in this study" not in said
    assert "make reproduce" not in said
    assert f"--results {study.results}" in said
    assert ("What the pendulum decides" in said) == ("pendulums" in study.figures)
    assert ("This page judges nothing" in said) == (name == "smoke.yaml")
    assert (tmp_path / "figures/overview.svg").is_file()
