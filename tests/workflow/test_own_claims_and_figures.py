"""Claims and figures of one's own, from the documentation: run, shown, and made again where it must be."""

import json
import re

import pandas as pd
import pytest

from tests.workflow.test_extending import blocks, followed

pytestmark = pytest.mark.heavy  # it runs two studies, each several times

MINE = "results/mine"


def source(folder):
    files = (path for path in (folder / "src").rglob("*") if path.is_file())
    return {path: path.read_bytes() for path in files if "__pycache__" not in path.parts}


@pytest.fixture(scope="module")
def claimed(tmp_path_factory):
    """The study of the page on claims, run, and the files below ``src`` before that."""
    folder = tmp_path_factory.mktemp("claimed")
    study, new = followed("claim", folder)
    before = source(folder)
    assert new == []
    study.jobs()
    return study, before, source(folder)


def test_an_own_claim_and_an_own_figure_touch_no_file_below_src(claimed):
    _, before, after = claimed
    assert before == after


def test_own_claims_are_judged_and_no_others(claimed):
    study, *_ = claimed
    verdicts = pd.read_parquet(study.folder / MINE / "tables/verdicts.parquet").set_index("claim")
    assert list(verdicts.index) == ["S1", "S2"]
    assert "not in this study" not in set(verdicts["verdict"])
    assert verdicts["n"].min() >= 2
    assert verdicts["figure"].isna().all()  # which is a number of the thesis
    recordings = {path.name for path in (study.folder / MINE / "recordings").glob("claim-*.rrd")}
    assert recordings == {"claim-S1.rrd"}


def test_the_page_shows_an_own_figure_and_what_it_decides(claimed):
    study, *_ = claimed
    results = study.folder / MINE
    words = json.loads((results / "figures/two-step-sizes.json").read_text("utf-8"))
    assert words["title"] == "Falls with two step sizes"
    assert words["claims"] == ["S1"]
    assert "what decides S1" in words["caption"]
    cells = {runs["cell"] for panel in words["panels"] for runs in panel["runs"]}
    assert cells == {"balancing/table/alpha-0.1", "balancing/table/alpha-1"}
    page = (results / "report/index.html").read_text("utf-8")
    section = page[page.index('aria-labelledby="heading-two-step-sizes"') :]
    section = section[: section.index("</section>")]
    assert "With α = 0.1 the table balances by the end." in section
    assert "<svg" in section
    for words in ("If you are the author", "the thesis says", "that were registered"):
        assert words not in page
    assert "what is claimed" in page
    assert '<a href="#two-step-sizes">Falls with two step sizes</a>' in page
    assert "config/mine-claims.yaml" in page
    assert 'id="C1"' not in page


def test_snakemakes_own_report_has_an_own_figure(claimed):
    study, *_ = claimed
    done = study.snakemake("--report", "own.html")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "two-step-sizes" in (study.folder / "own.html").read_text("utf-8")


def test_an_edit_makes_again_what_it_is_about(claimed):
    study, *_ = claimed
    claims, config = "config/mine-claims.yaml", "config/small.yaml"
    judged = {"verdicts": 1, "history": 1, "report": 1}
    study.edit(claims, "at_least: 1.2", "at_least: 1.3")
    assert study.plan() == judged
    study.edit(claims, "at_least: 0.8", "at_least: 0.7")
    assert study.plan() == {**judged, "figure": 1, "comparison": 1, "viewer": 1}
    study.edit(claims, "at_least: 1.3", "at_least: 1.2")
    study.edit(claims, "at_least: 0.7", "at_least: 0.8")
    study.edit(config, "{learner: table}", '{learner: table, colour: "#7A2048", label: mine}')
    planned = study.plan()
    assert planned["figure"] >= 1
    assert not any(rule.startswith("train") for rule in planned)
    study.edit(config, '{learner: table, colour: "#7A2048", label: mine}', "{learner: table}")
    study.edit(config, "title: Falls with", "title: All falls with")
    assert study.plan()["figure"] == 1
    study.edit(config, "title: All falls with", "title: Falls with")
    assert study.plan() == {}


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """The study of the page on figures, with its figure of panels drawn."""
    folder = tmp_path_factory.mktemp("drawn")
    study, new = followed("figure", folder)
    assert [str(path) for path in new] == ["config/figures/rewards.py"]
    ran = study.jobs("--", f"{MINE}/figures/table-and-small.svg")
    assert ran == {"train_seeds_0_to_1": 4, "figure": 1}
    return study


def test_ready_panels_are_drawn_in_the_colour_and_with_the_label_that_are_named(drawn):
    place = drawn.folder / MINE / "figures/table-and-small"
    words = json.loads(place.with_suffix(".json").read_text("utf-8"))
    picture = place.with_suffix(".svg").read_text("utf-8")
    assert len(words["panels"]) == 3  # that over α has no single runs
    assert words["runs"][0].startswith("balancing/small/alpha-0.1/seed-")
    for text in ("three units, α = 0.1", "best run", "Falls, α = 0.1", "step size α"):
        assert text in picture
    assert "#7a2048" in picture
    assert words["caption"].startswith("Which of them falls less")


def test_a_file_beside_the_configuration_draws_a_figure_and_is_followed(drawn):
    drawn.write(blocks("figure")["config/rewards.yaml"])
    drawn.jobs("--", "results/rewards/figures/rewards.svg")
    words = json.loads((drawn.folder / "results/rewards/figures/rewards.json").read_text("utf-8"))
    assert words["title"] == "The mean reward of every run"

    def planned():
        done = drawn.snakemake("--dry-run", "--", "results/rewards/figures/rewards.svg")
        assert done.returncode == 0, done.stderr
        return re.findall(r"^rule (\w+):", done.stdout + done.stderr, re.MULTILINE)

    assert planned() == []
    file = "config/figures/rewards.py"
    drawn.edit(file, "A row for each cell", "Rows for cells")
    assert planned() == []
    drawn.edit(file, "s=6", "s=7")
    assert planned() == ["figure"]
    drawn.edit(file, "s=7", "s=6")


@pytest.mark.parametrize(
    ("file", "old", "new", "expected"),
    [
        ("small.yaml", "figures: [rewards]", "figures: [reward]", "did you mean 'rewards'?"),
        ("small.yaml", "figures: [rewards]", "figures: [fig08]", "full-control/table/alpha-0.001"),
        ("figures/rewards.py", "FIGURE = ", "FIGUR = ", "rewards.py: FIGURE: must be a Declaration"),
        ("figures/rewards.py", "FIGURE = ", "FIGURE = 1 / 0  # ", "rewards.py: line 11: ZeroDivisionError"),
    ],
)  # fmt: skip
def test_a_figure_that_cannot_be_drawn_is_refused_before_anything_runs(
    file, old, new, expected, drawn
):
    drawn.write(blocks("figure")["config/rewards.yaml"])
    drawn.edit(f"config/{file}", old, new)
    done = drawn.snakemake("--dry-run")
    drawn.edit(f"config/{file}", new, old)
    said = done.stdout + done.stderr
    assert done.returncode != 0
    assert "Traceback" not in said
    assert expected in said
