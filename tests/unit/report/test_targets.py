"""The files that a study comes to: which they are, and which of them the page takes."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.paths import ROOT
from upswing.report import targets
from upswing.report.targets import Targets, templates
from upswing.study.check import asked
from upswing.study.config import validated
from upswing.study.paths import EVIDENCE_CSV, PAGE, RUNS_CSV
from upswing.study.paths import VIEWER as VIEWER_FOLDER
from upswing.study.sweeps import Sweep

TASK = {"kind": "balancing", "steps": 2_000}
STUDY = {
    "seeds": 4,
    "seeds_per_job": 2,
    "tasks": {"balancing": TASK},
    "architectures": {"table": {"learner": "table"}},
    "experiments": [{"tasks": ["balancing"], "architectures": ["table"], "alphas": [1, 0.5]}],
}
SWEPT = [f"tables/{name}.parquet" for name in ("selection", "readings", "decisive", "robust")]


def of(folder: Path, **more: Any) -> Targets:
    """The targets of a small study without claims and sweeps, with its results in a folder."""
    return Targets(validated({"small": {**STUDY, "results": str(folder), **more}}), {}, {})


def titled(**more: Any) -> Mapping[str, Any]:
    return {"experiments": [{**STUDY["experiments"][0], "title": "A change"}], **more}


def below(folder: Path, paths: list[str]) -> set[str]:
    return {str(Path(path).relative_to(folder)) for path in paths}


def touch(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.touch()


def test_the_page_and_the_viewer_stand_where_they_are_written():
    assert targets.OF_THE_PAGE == (PAGE, RUNS_CSV, EVIDENCE_CSV)
    assert f"{VIEWER_FOLDER}/index.html" == targets.VIEWER_PAGE


def test_the_page_shows_sweeps_that_have_been_run_or_are_asked_for(tmp_path):
    files = of(tmp_path)
    assert not below(tmp_path, files.of_page([])) & set(SWEPT)
    for asked_for in (
        "readings",
        "with_readings",
        f"{tmp_path}/tables/robust.parquet",
    ):  # no sweep selects
        assert below(tmp_path, files.of_page(["all", asked_for])) & set(SWEPT) == set(SWEPT[1:])
    touch(tmp_path / SWEPT[2])
    assert below(tmp_path, files.of_page(["all"])) & set(SWEPT) == {SWEPT[2]}


def test_the_default_is_selected_where_a_sweep_is_for_that(tmp_path):
    sweep = Sweep(vary=("biases",), how="grid", seeds=1, cells=("balancing/table/alpha-1",))
    study = of(tmp_path).study
    judging, both = (
        Targets(study, {}, dict.fromkeys(names, sweep))
        for names in (["tables"], ["networks", "tables"])
    )
    pictures = {f"figures/readings-tables.{kind}" for kind in ("svg", "png")}
    others = {f"figures/readings-networks.{kind}" for kind in ("svg", "png")}
    assert below(tmp_path, judging.readings) == {*SWEPT[1:], *pictures}
    assert below(tmp_path, both.readings) == {*SWEPT, *pictures, *others}


def test_the_page_shows_the_chapter_of_the_folder_below_once_it_is_there(tmp_path):
    files = of(tmp_path)
    before = below(tmp_path, files.of_page([]))
    touch(tmp_path / "beyond/tables/changes.parquet")
    touch(tmp_path / "beyond/tables/shortest.parquet")  # which the page does not read
    assert below(tmp_path, files.of_page([])) - before == {"beyond/tables/changes.parquet"}


def test_the_page_of_changes_takes_their_tables_before_they_are_there(tmp_path):
    predicted = ("prediction", "prediction_limits")
    names = ("bound", "bound_maps", "settling", *predicted, "changes")
    tables = {f"tables/{name}.parquet" for name in names}
    files = of(tmp_path, **titled())
    assert below(tmp_path, files.beyond) == tables <= below(tmp_path, files.of_page([]))
    assert below(tmp_path, files.beyond) <= below(tmp_path, files.everything)
    assert of(tmp_path).beyond == []


def test_a_figure_is_drawn_from_its_own_cells_and_from_a_run_of_each_job(tmp_path):
    files = of(tmp_path)
    one = {f"runs/balancing/table/alpha-1/seed-{seed}.windows.parquet" for seed in (0, 2)}
    all_cells = below(tmp_path, files.of_figure("overview"))
    assert len(all_cells) == 2 * len(files.matrix.cells)
    assert below(tmp_path, files.of_figure("bound")) == {
        "tables/bound.parquet",
        "tables/bound_maps.parquet",
        *all_cells,
    }
    assert below(tmp_path, files.of_figure("fig05")) == one < all_cells


@pytest.mark.parametrize("config", ["config", "beyond", "smoke"])
def test_what_is_forgotten_is_made_again_or_left_and_never_both(config):
    path = ROOT / f"config/{config}.yaml"
    files = Targets(
        *asked([path], {}, claims=ROOT / "config/claims.yaml", sweeps=ROOT / "config/readings.yaml")
    )
    assert not set(files.quick) & set(files.slow)
    assert len(set(files.quick)) == len(files.quick)
    assert set(files.everything) <= {*files.quick, *files.slow}
    assert {*files.swept, *files.readings} <= set(files.slow) or not files.groups


def test_the_page_is_made_from_every_template_style_and_text(tmp_path):
    for name in ("a.j2", "a.css", "a.js", "a.yaml", "parts/b.j2", "drawings/c.svg"):
        touch(tmp_path / name)
    expected = set(below(tmp_path, templates(tmp_path)))
    touch(tmp_path / "viewer.html")  # the viewer's
    touch(tmp_path / "pictures/d.png")  # the README's
    assert below(tmp_path, templates(tmp_path)) == expected
    assert len(expected) == 6
