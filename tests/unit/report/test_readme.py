"""What `make readme` renews: parts of README and documentation, their pictures, the animation."""

import re
import shutil
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from tests.conftest import CHROMIUM
from tests.paths import ROOT
from upswing.analysis.aggregate import write_tables
from upswing.cli.main import main
from upswing.figures import draw
from upswing.report.animation import (
    LEARNED,
    STEPS,
    THESIS,
    drawn,
    stretches,
)
from upswing.report.chapter import chapter
from upswing.report.lessons import EXPECTED, expected_of, lessons
from upswing.report.readme import (
    ANIMATION,
    FIGURES,
    PARTS,
    PICTURES,
    README,
    TABLE,
    renewed,
    verdicts_of,
    write_readme,
)
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, read_study, write_study
from upswing.runs.train import train
from upswing.study.claims import load_claims
from upswing.study.config import load, validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.paths import ROBUST, VERDICTS
from upswing.study.physical import PendulumOptions

TEMPLATES = ROOT / "report"
LARGEST = 300_000
"""Of the animation [bytes]."""

FINDINGS = Path("docs/findings.md")
TWO_TABLES = {
    "seeds": 3,
    "tasks": {"full-control": {"kind": "full-control", "steps": 4_000}},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [
        {"tasks": ["full-control"], "architectures": ["table"], "alphas": [0.001, 0.01]}
    ],
}


@pytest.fixture
def results_of_two(tmp_path):
    """A study with the two cells of the animation, in which seed 1 first stays up at step 1,000."""
    study = validated({"study": TWO_TABLES})
    matrix = Matrix(study)
    write_study(canonical(study), tmp_path)
    for spec in matrix.cells.values():
        train(spec, tmp_path)
    write_tables(tmp_path, matrix)
    found = Results(tmp_path)
    found.runs["first_stable_step"] = pd.NA
    found.runs.loc[found.runs["run"] == f"{LEARNED}/seed-1", "first_stable_step"] = 1_000
    return found


@pytest.mark.parametrize("page", PARTS, ids=str)
def test_a_page_shows_what_was_generated(page):
    text = (ROOT / page).read_text("utf-8")
    assert renewed(text, page, TEMPLATES) == text
    with pytest.raises(BadInput, match="there is no place for"):
        renewed("nothing", page, TEMPLATES)


def test_readme_and_findings_have_a_row_for_each_claim():
    claims = pd.read_csv(TEMPLATES / TABLE, dtype=str, keep_default_na=False)
    readme, whole = ((ROOT / page).read_text("utf-8") for page in (README, FINDINGS))
    for row in claims.to_dict("records"):
        said = f"{row['claim']}: {row['the thesis says']} | {row['estimate [95 %]']} | {row['verdict']}"
        assert f"| {said}" in readme
        assert f"| {row['claim']} | {row['the thesis says']} | {row['verdict']} |" in whole


def results_of_the_study():
    folder = ROOT / "results"
    there = (folder / VERDICTS).exists() and (folder / "study.json").exists()
    if not there or read_study(folder) != load(ROOT / "config/config.yaml"):
        pytest.skip("the study of config/config.yaml has not been run here")
    return folder


def test_the_verdicts_are_those_of_the_study_where_it_was_run():
    found = pd.read_parquet(results_of_the_study() / VERDICTS)
    shown = pd.read_csv(TEMPLATES / TABLE, dtype=str, keep_default_na=False)
    pd.testing.assert_frame_equal(shown, verdicts_of(found), check_dtype=False)


def test_what_was_expected_is_that_of_the_chapter_where_it_was_run():
    told = chapter(results_of_the_study())
    if told["folder"] is None or read_study(told["folder"]) != load(ROOT / "config/beyond.yaml"):
        pytest.skip("the study of config/beyond.yaml has not been run here")
    shown = pd.read_csv(TEMPLATES / EXPECTED, dtype=str, keep_default_na=False)
    pd.testing.assert_frame_equal(shown, pd.DataFrame(expected_of(told["changes"])))


def test_findings_have_a_row_for_each_expectation():
    expected = load_claims(ROOT / "config/beyond-claims.yaml")
    text = (ROOT / FINDINGS).read_text("utf-8")
    for claim, one in expected.items():
        assert f"| {claim}: {one.statement} |" in text
    changes = {one.title for one in load(ROOT / "config/beyond.yaml").experiments}
    assert set(lessons(TEMPLATES)) == changes
    for lesson in lessons(TEMPLATES).values():
        assert lesson in text


def test_the_animation_is_that_of_the_study_where_it_was_run():
    found = Results(results_of_the_study())
    assert drawn(stretches(found)) == (ROOT / PICTURES / ANIMATION).read_text("utf-8")


def test_everything_is_renewed_from_results(results, tmp_path):
    for name in FIGURES:
        draw(name, results)
    for name in ("report", "docs"):
        shutil.copytree(ROOT / name, tmp_path / name)
    shutil.copy(ROOT / README, tmp_path)
    (tmp_path / PICTURES / "overview.png").unlink()
    animation = (tmp_path / PICTURES / ANIMATION).read_bytes()
    write_readme(results.folder, tmp_path / "report", tmp_path / README)
    assert (tmp_path / PICTURES / "overview.png").stat().st_size > 5_000
    # This study has not the two cells.
    assert (tmp_path / PICTURES / ANIMATION).read_bytes() == animation
    for page in (README, FINDINGS):
        text = (tmp_path / page).read_text("utf-8")
        assert text != (ROOT / page).read_text("utf-8")
        assert text == renewed(text, page, tmp_path / "report")
    with pytest.raises(BadInput, match="`make reproduce` makes it"):
        write_readme(tmp_path, tmp_path / "report", tmp_path / README)
    (tmp_path / FINDINGS).unlink()
    with pytest.raises(BadInput, match=r"findings\.md: there is no such page"):
        write_readme(results.folder, tmp_path / "report", tmp_path / README)


def test_sweeps_of_older_code_are_not_shipped_as_those_of_today(results, tmp_path, capsys):
    for name in FIGURES:
        draw(name, results)
    for name in ("report", "docs"):
        shutil.copytree(ROOT / name, tmp_path / name)
    shutil.copy(ROOT / README, tmp_path)
    folder = tmp_path / "results"
    shutil.copytree(results.folder, folder, ignore=shutil.ignore_patterns("runs"))
    (folder / ROBUST).touch()  # it says nothing of what it was made from
    shipped = tmp_path / "report/readings.json"
    before = shipped.read_bytes()
    words = ["--templates", str(tmp_path / "report"), "--readme", str(tmp_path / README)]
    assert main(["readme", str(folder), *words]) == 0
    assert shipped.read_bytes() == before
    assert f"{shipped} stays as it is: the code that judges changed" in capsys.readouterr().out


def rotations(picture, number):
    """The rotations of a panel's rod [degrees], in the order of its frames."""
    frames = re.search(rf"@keyframes rod{number} \{{(.*?)\}}\}}", picture)[1]
    return np.array([float(turn) for turn in re.findall(r"rotate\((\S+?)deg\)", frames)])


def test_the_animation_plays_what_is_stored(results_of_two):
    left, right = stretches(results_of_two)
    picture = drawn([left, right])
    ET.fromstring(picture)  # noqa: S314  our own
    assert len(picture.encode()) < LARGEST
    first = 1_000 - 500
    assert f"step {first:,}" in right.subtitle
    for number, run, begin in (
        (0, results_of_two.median_run(THESIS).id, 4_000 - STEPS),
        (1, f"{LEARNED}/seed-1", first),
    ):
        stored = results_of_two.trajectory(run).set_index("step")["angle"]
        angle = stored.loc[range(begin, begin + STEPS, 8)].to_numpy(float)
        shown = np.radians(rotations(picture, number))
        assert len(shown) == STEPS // 8  # 40 ms a frame
        # A positive φ leans to the left, a positive rotation of SVG to the right.
        np.testing.assert_allclose(np.exp(-1j * shown), np.exp(1j * angle), atol=1e-3)
        assert np.abs(np.diff(shown)).max() < np.pi  # it never turns the long way round


def test_the_animation_is_the_same_again(results_of_two):
    again = Results(results_of_two.folder)
    again.runs["first_stable_step"] = results_of_two.runs["first_stable_step"]
    assert drawn(stretches(again)) == drawn(stretches(results_of_two))


def test_the_animation_plays_in_the_time_of_its_task(results_of_two):
    """With steps of 10 ms, twice as long a time, and 25 frames a second still."""
    here = drawn(stretches(results_of_two))
    task = results_of_two.task(THESIS)
    slow = task.model_copy(update={"pendulum": PendulumOptions(time_step=0.01)})
    for cell, spec in results_of_two.cells.items():
        results_of_two.cells[cell] = spec.model_copy(update={"task": slow})
    there = drawn(stretches(results_of_two))
    assert ("10s linear" in here, "over 10 s" in here) == (True, True)
    assert ("20s linear" in there, "over 20 s" in there) == (True, True)
    assert len(rotations(here, 0)) == STEPS // 8
    assert len(rotations(there, 0)) == STEPS // 4


def test_the_animation_shows_the_end_where_nothing_has_learned(results_of_two):
    results_of_two.runs["first_stable_step"] = pd.NA
    assert [f"step {4_000 - STEPS:,}" in panel.subtitle for panel in stretches(results_of_two)] == [
        True,
        True,
    ]


@pytest.mark.parametrize("less_motion", [False, True])
def test_it_moves_as_an_image_unless_less_motion_is_asked_for(browser, tmp_path, less_motion):
    # The system's wish, which an image is told of; what Playwright pretends, only the page is.
    options = ["--no-sandbox", *(["--force-prefers-reduced-motion"] if less_motion else [])]
    chromium = browser.browser_type.launch(executable_path=CHROMIUM, args=options)
    page = chromium.new_page(viewport={"width": 740, "height": 350})
    picture = (ROOT / PICTURES / ANIMATION).as_uri()
    (tmp_path / "page.html").write_text(f'<img src="{picture}">', "utf-8")
    page.goto((tmp_path / "page.html").as_uri())
    page.wait_for_function("document.images[0].complete && document.images[0].naturalWidth")
    seen = set()
    for _ in range(4):
        page.wait_for_timeout(150)
        seen.add(page.screenshot())
    chromium.close()
    assert (len(seen) == 1) == less_motion
