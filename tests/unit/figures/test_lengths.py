"""Steps, times and tiles in the words of figures: those of the tasks that are shown."""

import numpy as np
import pytest

from tests.helpers import ARCHITECTURES
from upswing.analysis.aggregate import write_tables
from upswing.figures import panels, told
from upswing.figures.labels import steps_axis
from upswing.figures.lengths import end_of, grid_of, in_steps, step_label
from upswing.figures.measures import axis_of
from upswing.figures.style import plt
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.runs.train import train
from upswing.study.claim_parts import Part
from upswing.study.config import validated
from upswing.study.matrix import Matrix
from upswing.study.task import task_named

OWN = {
    "pendulum": {"length": 0.4, "accelerations": [-20, -10, 0, 10, 20], "time_step": 0.01},
    "tiles": {"angle_parts": 12, "velocity_parts": 30},
}
CELL = "full-control/table/alpha-0.001"
CELLS = [CELL, "balancing/table/alpha-1", "full-control/modular-table/alpha-0.001"]


def task(name="full-control", kind="full-control", steps=1_000_000, **keys):
    return task_named(name, kind=kind, steps=steps, **keys)


THESIS, SLOW = task(), task(pendulum={"time_step": 0.01})


def test_a_step_is_as_long_as_the_task_says():
    assert step_label([THESIS, THESIS]) == "step of 5 ms"
    assert step_label([SLOW]) == "step of 10 ms"
    assert step_label([task(pendulum={"time_step": 0.0125})]) == "step of 12.5 ms"
    assert step_label([THESIS, SLOW]) == "step"


def test_a_stretch_of_the_thesis_is_the_same_time_in_other_steps():
    assert in_steps(100_000, [THESIS]) == in_steps(100_000, []) == "100,000 steps"
    assert in_steps(100_000, [SLOW, SLOW]) == "50,000 steps"
    assert in_steps(100_000, [SLOW, THESIS]) == "500 s"


def test_the_end_is_the_last_fifth_of_a_run_that_is_short():
    short, shorter = task(steps=300_000), task(steps=20_000)
    assert end_of([]) == end_of([THESIS, task(steps=5_000_000)]) == "100,000 steps"
    assert end_of([task(kind="balancing", steps=50_000), THESIS]) == "100,000 steps"
    assert end_of([SLOW]) == "50,000 steps"
    assert end_of([SLOW, THESIS]) == "500 s"
    assert end_of([short]) == "60,000 steps"
    assert end_of([short, shorter]) == "fifth"
    assert end_of([THESIS, short]) == "fifth or 100,000 steps, whichever is shorter"


def test_a_measure_says_of_which_steps_it_is():
    def label(measure, *tasks):
        part = {"says": "…", "because": "…", "kind": "median", "cells": ["a"], "measure": measure}
        return axis_of(
            Part.model_construct(**{"paired": False, "per": None, "where": {}, **part}), tasks
        ).label

    assert label("upright_at_end", THESIS) == "upright in the last 100,000 steps [%]"
    assert label("upright_at_end", SLOW) == "upright in the last 50,000 steps [%]"
    assert label("falls_first_5000", THESIS) == "falls in the first 5,000 steps"
    assert label("falls_first_5000", SLOW) == "falls in the first 5,000 steps of 5 ms"


@pytest.fixture(scope="module")
def own(tmp_path_factory):
    """Cells of the thesis, of other pendulums."""
    folder = tmp_path_factory.mktemp("own")
    asked = validated({"study": {
        "seeds": 2,
        "tasks": {
            "balancing": {"kind": "balancing", "steps": 6_000, **OWN},
            "full-control": {"kind": "full-control", "steps": 6_000, **OWN},
        },
        "architectures": {name: ARCHITECTURES[name] for name in ("table", "modular-table", "idle", "random")},
        "experiments": [
            {"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]},
            {"tasks": ["full-control"], "architectures": ["table", "modular-table"], "alphas": [0.001]},
            {"tasks": ["full-control"], "architectures": ["idle", "random"]},
        ],
    }})  # fmt: skip
    write_study(canonical(asked), folder)
    for spec in Matrix(asked).cells.values():
        train(spec, folder)
    write_tables(folder, Matrix(asked))
    return Results(folder)


def test_the_tiles_are_those_of_the_task(own, study):
    assert [grid_of(study.cells[cell]) for cell in CELLS] == ["8 × 20", "4 × 20", "4 × 20"]
    assert [grid_of(own.cells[cell]) for cell in CELLS] == ["12 × 30", "12 × 30", "6 × 30"]


def test_figures_are_drawn_of_another_pendulum_and_say_so(own, claims):
    from tests.unit.figures.conftest import drawn

    for name, words in (
        ("fig05", ("12 × 30 tiles", "in the first 1,250 steps")),
        ("fig08", ("12 × 30 tiles", "90 % of 2,500 steps in a row")),
        ("fig10", ("two tables of 6 × 30 tiles",)),
        (
            "overview",
            (
                "that balance",
                "90 % of their last 1,200 steps",
            ),
        ),
        ("step-sizes", ("90 % of the last 1,200 steps",)),
        ("learning-curves", ()),
    ):
        drawing = drawn(name, own, claims)
        for one in words:
            assert one in drawing.caption, drawing.caption
        labels = {axes.get_xlabel() for axes in drawing.figure.axes if axes.get_visible()}
        assert "step of 5 ms" not in labels
        assert "step of 10 ms" in labels or name in ("overview", "step-sizes")
        plt.close(drawing.figure)


def test_what_runs_away_is_named_where_its_own_pushes_hold_it(own):
    cell = "full-control/idle/alpha-none"
    run = own.median_run(cell)
    held = np.radians(116.0)
    away = run._replace(trajectory=run.trajectory.assign(angle=held, angular_velocity=0.0))
    figure, axes = plt.subplots()
    (phase,) = panels.angle_histogram(axes, away, cell)
    assert phase.name == "runs away"
    assert axes.get_xlabel() == "step of 10 ms"
    plt.close(figure)


def test_an_axis_of_several_tasks_says_no_length():
    figure, axes = plt.subplots()
    axes.set_xlim(0, 100)
    steps_axis(axes, [THESIS, SLOW])
    assert axes.get_xlabel() == "step"
    plt.close(figure)


def test_how_long_a_run_stood_is_said_in_its_own_steps(own):
    assert "5,000" not in told.stood(own, CELL)
