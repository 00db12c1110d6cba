"""A run whose values overflow: it is named, learns no more, and is counted nowhere."""

import numpy as np
import pandas as pd
import pytest

from tests.helpers import make_spec, run
from upswing.analysis.aggregate import summarise
from upswing.analysis.verdicts import judge
from upswing.physics.braking import Stoppable
from upswing.physics.environment import NEVER, empty_trajectory
from upswing.runs.metrics import measure
from upswing.runs.outcome import outcome_of
from upswing.runs.results import OwnRuns, Results
from upswing.runs.rows import collected
from upswing.runs.simulation import prepare
from upswing.runs.study_file import canonical, write_study
from upswing.runs.train import train
from upswing.study import loading
from upswing.study.claims import Claim
from upswing.study.config import validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix

OVERFLOWING = {"learning_rate": 1, "initial_weights": 1, "reward_unit": "degrees", "biases": "both"}
STEPS = 6_000


def overflowing(steps=STEPS):
    """A specification of networks that overflow within a few hundred steps."""
    return make_spec("full-control", "networks-30", 1.0, steps=steps, **OVERFLOWING)


@pytest.fixture(scope="module")
def diverged():
    trajectory, learned = run(overflowing())
    return trajectory, learned


def test_the_step_is_the_first_whose_values_are_not_finite(diverged):
    trajectory, learned = diverged
    at = int(trajectory.diverged_at[0])
    assert 0 < at < STEPS
    assert not all(np.isfinite(values).all() for values in learned.values())
    assert measure(trajectory, False, Stoppable(20.0, 20.0)).diverged_at == at
    # Before it every step learned; from it on none did.
    assert not np.isnan(trajectory.td_error[: at - 1]).any()
    assert np.isnan(trajectory.td_error[at:]).all()


def test_it_learns_no_more(diverged):
    trajectory, learned = diverged
    at = int(trajectory.diverged_at[0])
    shorter, then = run(overflowing(at + 1))
    assert int(shorter.diverged_at[0]) == at
    for name, values in learned.items():
        np.testing.assert_array_equal(values, then[name], err_msg=name)


def test_learned_in_pieces_it_is_the_same(diverged):
    trajectory, learned = diverged
    again, then = run(overflowing(), pieces=7)
    assert int(again.diverged_at[0]) == int(trajectory.diverged_at[0])
    np.testing.assert_array_equal(again.td_error, trajectory.td_error)
    for name, values in learned.items():
        np.testing.assert_array_equal(values, then[name], err_msg=name)


def test_a_trajectory_that_is_used_again_forgets_it(diverged):
    spec = make_spec("full-control", "table", 0.5, steps=STEPS)
    trajectory = diverged[0]._replace(diverged_at=np.array([17]))
    prepare(spec, 0).advance(trajectory, 0, STEPS)
    assert int(trajectory.diverged_at[0]) == NEVER


def test_an_overflow_that_no_step_meets_again_is_found_in_what_was_learned():
    spec = make_spec("full-control", "table", 0.5, steps=STEPS)
    setting, trajectory = prepare(spec, 0), empty_trajectory(STEPS)
    setting.advance(trajectory, 0, STEPS)
    next(iter(setting.learner.learned.values())).flat[-1] = np.inf
    assert outcome_of(spec, 0, setting, trajectory).row["diverged_at"] == STEPS - 1


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """A study in which every network overflows and no table does."""
    study = validated(
        {
            "study": {
                "seeds": [0, 2, 3],
                "tasks": {"full-control": {"kind": "full-control", "steps": STEPS}},
                "architectures": {
                    "table": {"learner": "table"},
                    "networks-30": {"learner": "networks", "hidden": [30]},
                },
                "experiments": [
                    {"tasks": ["full-control"], "architectures": ["table", "networks-30"], "alphas": [1]}
                ],
                "readings": OVERFLOWING,
            }
        }
    )  # fmt: skip
    folder = tmp_path_factory.mktemp("overflowing")
    write_study(canonical(study), folder)
    for cell in Matrix(study).cells.values():
        train(cell, folder)
    found = Results(folder)
    runs = collected(folder, Matrix(study).cells.values())
    found.__dict__["runs"] = runs.assign(cell=runs["run"].str.rpartition("/")[0])
    return found


NETWORKS, TABLE = "full-control/networks-30/alpha-1", "full-control/table/alpha-1"


def test_such_a_run_is_counted_apart_in_its_cell(results):
    assert results.cell(NETWORKS)["diverged_at"].notna().all()
    assert len(results.counted(NETWORKS)) == 0
    assert len(results.counted(TABLE)) == 3
    cells = summarise(results.runs).set_index("cell")
    assert cells.loc[NETWORKS, ["runs", "runs_diverged"]].tolist() == [0, 3]
    assert cells.loc[TABLE, ["runs", "runs_diverged"]].tolist() == [3, 0]
    assert np.isnan(cells.at[NETWORKS, "upright_share_mean"])


def test_it_is_no_evidence(results):
    part = {
        "says": "few runs stand", "kind": "share", "cells": [NETWORKS], "because": "it is a test",
        "where": {"upright_at_end": {"at_least": 0.9}}, "at_most": 0.2, "partly": 0.5,
    }  # fmt: skip
    claim = Claim.model_validate({"statement": "a", "section": "§1", "parts": [part]})
    (row,) = judge(results, "C1", claim)
    assert row.n == 0
    assert row.verdict == "inconclusive"


def test_a_figure_shows_where_it_ended(results):
    ensemble = results.ensemble(NETWORKS)
    assert ensemble.diverged.all()
    at = results.cell(NETWORKS)["diverged_at"].to_numpy(int)
    for line, step in zip(ensemble.upright_share, at, strict=True):
        known = ensemble.last_step[~np.isnan(line)]
        assert len(known) == 0 or known.max() <= step
        assert np.isnan(line[-1])
    assert not np.isnan(results.ensemble(TABLE).upright_share).any()


def test_the_step_stands_in_the_table_of_runs(results):
    assert results.runs["diverged_at"].dtype == "Int64"
    assert pd.isna(results.cell(TABLE)["diverged_at"]).all()


@pytest.mark.parametrize("name", ["overview", "learning-curves", "step-sizes"])
def test_figures_are_drawn_where_every_run_diverged(results, name):
    only = Results(results.folder)
    networks = {NETWORKS: results.cells[NETWORKS]}
    only.__dict__.update(study=results.study, cells=networks, runs=results.cell(NETWORKS))
    drawing = loading.load("figures", name).draw(only)
    assert drawing.figure.axes
    assert drawing.caption


def test_runs_of_an_older_version_are_named(results, monkeypatch):
    monkeypatch.setattr(
        "upswing.runs.results.collected",
        lambda *_: results.cell(TABLE).drop(columns="diverged_at"),
    )
    with pytest.raises(BadInput, match="its runs are of an older version; run the study again"):
        OwnRuns(results.folder).counted(TABLE)
