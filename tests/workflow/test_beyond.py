"""The chapter beyond the thesis: its tables from runs, its search by a rule, its workflow, its place in the page."""

import re
from copy import deepcopy

import numpy as np
import pandas as pd
import pytest
import yaml

from tests.paths import ROOT
from tests.predicted import made_up_prediction
from tests.workflow.small_study import Study
from upswing.analysis.ablation import EVERY_TIME
from upswing.analysis.search import chosen, upright_shares
from upswing.optimal.rows import Row
from upswing.optimal.settling import settle
from upswing.optimal.state_grid import Grid
from upswing.physics.environment import empty_trajectory
from upswing.physics.pendulum import Pendulum
from upswing.report.chapter import chapter
from upswing.report.page import write_report
from upswing.runs.files.tables import write_table
from upswing.study.config import load, validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix, canonical_search, cells_of
from upswing.study.paths import BOUND, CHANGES, CHOSEN, MAPS, SETTLING, SHORTEST
from upswing.study.readings import Readings

pytestmark = pytest.mark.heavy  # it runs studies with sweeps, or beyond the thesis

EXPECTED = {
    "E1": {
        "statement": "Overlapping tiles are not enough in 6,000 steps.",
        "cell": "full-control/tilings/alpha-1",
        "parts": [
            {
                "says": "tables on overlapping tiles that stand at the end", "kind": "share",
                "cells": ["full-control/tilings/alpha-1"], "where": {"upright_at_end": {"at_least": 0.9}},
                "at_most": 0.99, "partly": 1.0, "because": "it is short",
            }
        ],
    },
    "E2": {
        "statement": "Every table falls.",
        "cell": "balancing/table/alpha-0.1",
        "parts": [
            {
                "says": "tables that fall before the last fifth", "kind": "share",
                "cells": ["balancing/table/alpha-0.1"], "where": {"falls": {"at_most": 0}},
                "at_least": 0.99, "partly": 0.9, "because": "it is the contrary of what is claimed",
            }
        ],
    },
}  # fmt: skip
SMALL = {
    "results": "results/beyond",
    "claims": "expected.yaml",
    "seeds": [5000, 5001, 5002],
    "seeds_per_job": 15,
    "tasks": {
        "balancing": {"kind": "balancing", "steps": 6_000},
        "full-control": {"kind": "full-control", "steps": 6_000},
        "full-control-shaped": {"kind": "full-control", "steps": 6_000, "shaping": 10},
    },
    "architectures": {
        "table": {"learner": "table"},
        "tilings": {"learner": "table", "coding": "tilings", "discount": 0.9},
        "sarsa": {"learner": "table", "method": "sarsa"},
        "energy-lqr": {"learner": "energy-lqr", "coding": "continuous"},
    },
    "experiments": [
        {"title": "As in the thesis", "tasks": ["balancing", "full-control"], "architectures": ["table"], "alphas": [0.1]},
        {"title": "Other tiles", "source": "§3.3 names them.", "tasks": ["full-control"], "architectures": ["tilings"], "alphas": [1]},
        {"title": "Another reward", "tasks": ["full-control-shaped"], "architectures": ["sarsa"], "alphas": [0.1]},
        {"title": "Control theory", "tasks": ["full-control"], "architectures": ["energy-lqr"]},
    ],
    "search": {
        "task": "full-control",
        "seeds": [1000, 1001],
        "lengths": [2_000, 6_000],
        "candidates": [
            {"title": "the thesis's own means", "architectures": ["table"], "alphas": [0.1]},
            {"title": "one change", "architectures": ["tilings", "sarsa"], "alphas": [1, 0.1]},
        ],
    },
}  # fmt: skip


def made_up_bound(folder):
    """Numbers of the bound as they might be; what they really are is tested elsewhere, and takes longer."""
    rows = [
        Row("catchable_speed", 20.2, "rad/s", "exact"),
        Row("stoppable_speed", 20.2, "rad/s", "exact"),
        *(Row("catchable_speed", value, "rad/s", grid) for value, grid in ((20.1, "a"), (20.2, "b"))),
        *(Row(name, 0.6, "s", "b", policy="fastest") for name in (
            "time_from_hanging", "time_from_hanging_followed", "mean_time_from_rest",
        )),
        *(Row(name, value, "", "b", policy="optimal") for name, value in (
            ("lowest_discount_from_hanging", 0.874), ("lowest_discount_from_all", 0.966),
        )),
        *(Row(name, 1.0, "", "b", policy=policy) for policy in ("fastest", "tiles") for name in (
            "explored_upright_share", "success_share",
        )),
        *(Row(name, value, "", "b", policy="optimal", discount=discount)
          for discount in (0.7, 0.97) for name, value in (
            ("success_share", discount), ("success_from_hanging", discount > 0.9),
            ("explored_upright_share", 0.6), ("explored_never_upright", 0.4), ("mean_reward", -3.0),
        )),
    ]  # fmt: skip
    write_table(folder / BOUND, pd.DataFrame(rows).astype({"discount": "float64"}))
    angles, speeds = (axis.ravel() for axis in np.meshgrid(
        np.linspace(-3, 3, 7), np.linspace(-20, 20, 9), indexing="ij",
    ))  # fmt: skip
    maps = {
        "angle": angles,
        "angular_velocity": speeds,
        "time_to_upright": np.abs(angles),
        "keepable": np.abs(angles) < 1,
    }
    actions = {f"action_{discount}": np.arange(len(angles)) % 3 for discount in (0.7, 0.97)}
    write_table(folder / MAPS, pd.DataFrame({**maps, **actions}))
    write_table(folder / SETTLING, pd.DataFrame(settle(Pendulum(), Grid(24, 21), 0.97)))
    made_up_prediction(folder)


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """A small study of changes, run by Snakemake; the bound is there already."""
    one = Study(tmp_path_factory.mktemp("beyond"))
    (one.folder / "config/expected.yaml").write_text(yaml.safe_dump(EXPECTED), "utf-8")
    one.write(SMALL)
    made_up_bound(one.folder / "results/beyond")
    one.ran = one.jobs()
    return one


def test_every_part_of_the_chapter_has_its_job(study):
    assert study.ran == {
        "study": 1, "train_seeds_5000_to_5002": 5, "tables": 1, "verdicts": 1, "history": 1, "comparison": 5,
        "changes": 1, "shortest": 1, "figure": 7, "viewer": 1, "report": 1,
    }  # fmt: skip
    assert study.jobs() == {}


def test_each_change_has_its_row(study):
    folder = study.folder / "results/beyond"
    changes = pd.read_parquet(folder / CHANGES)
    runs = pd.read_parquet(folder / "tables/runs.parquet")
    content = validated({"small": SMALL})
    assert changes["cell"].tolist() == [c for e in content.experiments for c in cells_of(e)]
    assert changes["change"].tolist() == ["As in the thesis"] * 2 + [
        "Other tiles",
        "Another reward",
        "Control theory",
    ]
    for _, row in changes.iterrows():
        own = runs[runs["run"].str.startswith(f"{row['cell']}/")]
        balanced = (own["falls_last_fifth"] == 0).sum()
        upright = own["upright_share"]
        first = (
            (balanced, balanced)
            if row["kind"] == "balancing"
            else ((upright >= 0.9).sum(), (upright >= EVERY_TIME).sum())
        )
        assert (row["successes"], row["sure"]) == first
        assert row["success_low"] <= row["success"] <= row["success_high"]
        assert row["upright"] == pytest.approx(upright.mean())
        assert row["missing"] == pytest.approx(1 - upright.mean())
        assert row["missing_low"] <= row["missing"] <= row["missing_high"]
        assert row["stable"] == own["first_stable_step"].notna().sum()
        assert np.isfinite(row["stable_step"]) == (row["stable"] >= len(own) / 2)
        assert row["median_run"] in own["run"].tolist()
        assert 1 < row["nanoseconds"] < 1e6
    assert changes["discount"].tolist() == [0.7, 0.7, 0.9, 0.7, 0.7]
    assert changes["alpha"].isna().tolist() == 4 * [False] + [True]


def test_the_page_shows_the_chapter(study):
    page = (study.folder / "results/beyond/report/index.html").read_text("utf-8")
    for words in ("What each change buys", "Other tiles", "20.2000 rad/s", "0.874"):
        assert words in page
    tour = re.search(r'id="tour".*?</ol>', page, re.DOTALL)[0]
    entries = [re.sub(r"<[^>]*>", "", entry) for entry in tour.split("\n<li><strong>")[1:]]
    assert [entry.partition(".")[0] for entry in entries] == [
        "As in the thesis", "Other tiles", "Another reward", "Control theory",
    ]  # fmt: skip
    assert ["E2" in entry for entry in entries] == [True, False, False, False]
    assert ["E1" in entry for entry in entries] == [False, True, False, False]
    assert "§3.3 names them." in entries[1]
    assert "does not hold" in entries[0]
    assert "reproduced" not in re.sub(
        r"<style>.*?</style>|<script.*?</script>|class=\"[^\"]*\"", "", page, flags=re.DOTALL
    )
    for claim in EXPECTED:
        assert f'href="#{claim}"' in tour
        assert f'id="{claim}"' in page
    assert re.search(r">energy-lqr</td><td[^>]*>–</td>", page)  # it has no α
    links = re.findall(r'href="(viewer/[^"#]*)#([^"]*)"', page)
    kept = {
        path.stem for path in (study.folder / "results/beyond/report/viewer/recordings").iterdir()
    }
    shown = re.search(r'id="buys".*?</table>', page, re.DOTALL)[0]
    for name in re.findall(r'href="viewer/index.html#([^"]*)"', shown):
        assert name in kept
    assert len(links) > 4


def test_the_studys_own_page_has_the_chapter_once_it_has_been_run(study, results, tmp_path):
    import shutil

    folder = tmp_path / "results"
    shutil.copytree(results.folder, folder, ignore=shutil.ignore_patterns("runs", "beyond"))
    (folder / "report").mkdir(exist_ok=True)
    write_report(folder, ROOT / "report")
    assert 'id="beyond"' not in (folder / "report/index.html").read_text("utf-8")
    shutil.copytree(study.folder / "results/beyond", folder / "beyond")
    write_report(folder, ROOT / "report")
    page = (folder / "report/index.html").read_text("utf-8")
    assert 'id="beyond"' in page
    assert 'id="verdicts"' in page
    for place in set(re.findall(r'href="(\.\./beyond/[^"#]*)', page)):
        assert (folder / "report" / place).resolve().is_file(), place
    assert 'href="../beyond/report/index.html#E1"' in page
    assert chapter(folder)["own"] is False


def test_a_change_of_the_search_searches_again_and_nothing_else_does(study):
    def planned():
        done = study.snakemake("-n")
        text = done.stdout + done.stderr
        assert done.returncode == 0, text
        return {"shortest"} & set(re.findall(r"^(?:local)?rule (\w+):", text, re.MULTILINE))

    other_threshold = deepcopy(SMALL)
    other_threshold["experiments"][0]["title"] = "As the author did it"
    study.write(other_threshold)
    assert planned() == set()
    longer = deepcopy(SMALL)
    longer["search"]["lengths"] = [2_000, 4_000, 6_000]
    study.write(longer)
    assert planned() == {"shortest"}
    study.write(SMALL)
    assert planned() == set()


def test_the_search_tried_all_candidates(study):
    tried = pd.read_parquet(study.folder / "results/beyond" / SHORTEST)
    assert len(tried) == (1 + 4) * 2
    assert (tried["seeds"] == 2).all()
    best = pd.read_parquet(study.folder / "results/beyond" / CHOSEN)
    assert best["title"].tolist() == ["the thesis's own means", "one change"]


def test_a_shorter_training_is_the_beginning_of_a_longer_one():
    study = validated(
        {"small": {**SMALL, "search": {**SMALL["search"], "lengths": [3_000, 6_000]}}}
    )
    spec = Matrix(study).spec("full-control", "tilings", 1.0, (1000, 1001))
    shares = upright_shares(spec, study.search, empty_trajectory(6_000))
    alone = study.search.model_copy(update={"lengths": (3_000,)})
    again = upright_shares(spec, alone, empty_trajectory(3_000))
    np.testing.assert_array_equal(shares[:, 0], again[:, 0])
    assert shares.shape == (2, 2)


def tried(*candidates):
    """A table of what was tried: (group, architecture, sure seeds of 5 after 10, 20, 30 steps)."""
    return pd.DataFrame(
        [
            {"group": group, "title": f"group {group}", "architecture": name, "alpha": 0.1,
             "discount": 0.7, "steps": steps, "seeds": 5, "sure": sure, "worst": 0.0}
            for group, name, *counts in candidates
            for steps, sure in zip((10, 20, 30), counts, strict=True)
        ]
    )  # fmt: skip


@pytest.mark.parametrize(
    ("candidates", "expected"),
    [
        ([(0, "a", 5, 5, 5), (0, "b", 4, 5, 5)], [("a", 10, 5)]),
        ([(0, "a", 5, 4, 5), (0, "b", 4, 5, 5)], [("b", 20, 5)]),  # luck at first is not reliable
        ([(0, "a", 0, 5, 5), (0, "b", 0, 5, 5)], [("a", 20, 5)]),  # of equals the first
        ([(0, "a", 5, 5, 3), (0, "b", 0, 0, 4)], [("b", np.inf, 4)]),  # none: the nearest
        ([(0, "a", 0, 0, 5), (1, "b", 5, 5, 5)], [("a", 30, 5), ("b", 10, 5)]),
    ],
)
def test_the_rule_chooses_the_shortest_reliable_training_of_each_group(candidates, expected):
    best = chosen(tried(*candidates))
    assert list(zip(best["architecture"], best["steps"], best["sure"], strict=True)) == expected


def problems_of(**search):
    with pytest.raises(BadInput) as caught:
        validated({"beyond.yaml": {**SMALL, "search": {**SMALL["search"], **search}}})
    return "\n".join(caught.value.problems)


def test_a_search_that_cannot_be_is_refused():
    assert "search.task" in problems_of(task="balancing")
    assert "on these seeds" in problems_of(seeds=[5001, 1])
    one = [{"title": "x", "architectures": ["tabel"], "alphas": [1]}]
    assert "did you mean 'table'?" in problems_of(candidates=one)


def test_the_chapters_own_configuration_searches_and_reports_on_different_seeds():
    study = load(ROOT / "config/beyond.yaml")
    assert len(study.seeds) == len(study.search.seeds) == 30
    assert not set(study.seeds) & set(study.search.seeds)
    assert all(experiment.title for experiment in study.experiments)
    assert "tilings" in canonical_search(study)


def test_every_part_there_is_is_used():
    """A learner, encoder or algorithm that no study in ``config/`` uses is tried by nobody."""
    from upswing.study.loading import parts

    files = [
        path
        for path in (ROOT / "config").glob("*.yaml")
        if "experiments:" in path.read_text("utf-8")
    ]
    assert len(files) >= 3
    used = [architecture for path in files for architecture in load(path).architectures.values()]
    for kind, key in (("learners", "learner"), ("features", "coding"), ("algorithms", "method")):
        # An agent from elsewhere is adopted and no part of a study (docs/adopt.md).
        unused = set(parts(kind)) - {getattr(one, key) for one in used} - {"adopted"}
        assert not unused, (
            f"name {unused} in config/beyond.yaml, or in a study of your own in config/"
        )


def test_both_configurations_have_the_same_readings():
    content = [
        yaml.safe_load((ROOT / f"config/{name}.yaml").read_text()) for name in ("config", "beyond")
    ]
    assert content[0]["readings"] == content[1]["readings"]


def test_an_algorithm_without_a_body_is_refused(monkeypatch):
    from upswing.agents import algorithms, features
    from upswing.physics import tasks

    readings = Readings()
    plan = features.Plan(tasks.create("balancing", readings), {"modular": False}, readings)
    design = algorithms.Design(
        features.create("grid", plan), 0.7, {}, readings, np.random.default_rng(0)
    )
    sarsa = type(algorithms.create("sarsa", design))
    monkeypatch.delitem(algorithms._learn_from_by_type.bodies, sarsa)
    with pytest.raises(TypeError, match="no body under @learn_from_of"):
        algorithms.create("sarsa", design)
