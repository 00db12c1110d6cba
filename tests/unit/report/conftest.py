"""What the tests of the page share: the page of a small study, and of the thesis's study where it was run."""

from pathlib import Path

import pytest

from tests.paths import ROOT
from upswing.figures import draw, drawable
from upswing.recordings.comparison import write_comparisons
from upswing.recordings.viewer import write_viewer
from upswing.report.page import page_of, write_report
from upswing.runs.study_file import read_study
from upswing.study.claims import load_claims
from upswing.study.config import load
from upswing.study.paths import PAGE, VERDICTS


@pytest.fixture(scope="session")
def whole(results):
    """The small study with its page and everything beside it that the page links."""
    claims = load_claims(Path("config/claims.yaml"))
    for name in drawable(results.cells):
        draw(name, results, claims)
    write_comparisons(results, claims)
    write_viewer(results, claims, Path("report"))
    write_report(results.folder, Path("report"))
    return results


@pytest.fixture(scope="session")
def small_page(whole):
    """The address of the small study's page."""
    return (whole.folder / PAGE).resolve().as_uri()


@pytest.fixture(scope="session")
def thesis_page(tmp_path_factory):
    """The address of the page of the thesis's study, made of the results here by the templates as they are."""
    folder = ROOT / "results"
    there = (folder / VERDICTS).exists() and (folder / "study.json").exists()
    if not there or read_study(folder) != load(ROOT / "config/config.yaml"):
        pytest.skip("the study of config/config.yaml has not been run here")
    page = tmp_path_factory.mktemp("thesis") / "index.html"
    page.write_text(page_of(folder, ROOT / "report").html, "utf-8")
    return page.as_uri()


@pytest.fixture(params=["small", "thesis"])
def any_page(request):
    """The page of either study."""
    return request.getfixturevalue(f"{request.param}_page")


@pytest.fixture
def watched(browser):
    """Opens a page with what its reader prefers; the test fails if the page complains of anything."""
    contexts, said = [], []

    def opened(address, width=1280, **preferred):
        context = browser.new_context(viewport={"width": width, "height": 800}, **preferred)
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda message: said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(address)
        return page

    yield opened
    for context in contexts:
        context.close()
    assert said == []
