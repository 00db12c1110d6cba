"""The figure of the bound: the actions and the reach are those of the pendulum that it is about."""

import numpy as np
import pandas as pd
import pytest

from upswing.figures.style import plt
from upswing.runs.files.tables import write_table
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.study import loading
from upswing.study.config import validated
from upswing.study.paths import BOUND, MAPS

STRONG = {"length": 0.4, "accelerations": [-20, -10, 0, 10, 20]}


def folder_of(folder, actions, **task):
    """A folder with made-up maps in which every action is the best somewhere."""
    study = {
        "seeds": 1, "tasks": {"full-control": {"kind": "full-control", "steps": 1_000, **task}},
        "architectures": {"table": {"learner": "table"}},
        "experiments": [{"tasks": ["full-control"], "architectures": ["table"], "alphas": [0.1]}],
    }  # fmt: skip
    write_study(canonical(validated({"study": study})), folder)
    angle, velocity = (
        axis.ravel() for axis in np.meshgrid(np.linspace(-3, 3, 9), np.linspace(-25, 25, 11))
    )
    best = np.arange(len(angle)) % actions
    frame = pd.DataFrame({
        "angle": angle, "angular_velocity": velocity, "time_to_upright": np.abs(angle),
        "keepable": np.abs(angle) < 1, "upright": np.abs(angle) < 0.3, "action_fastest": best,
        "action_0.7": best, "action_0.97": best[::-1],
    })  # fmt: skip
    write_table(folder / MAPS, frame)
    row = {
        "task": "full-control", "quantity": "lowest_discount_from_hanging", "value": 0.95, "unit": "",
        "discount": np.nan, "policy": "", "grid": "720 × 801", "note": "",
    }  # fmt: skip
    write_table(folder / BOUND, pd.DataFrame([row]))
    return Results(folder)


@pytest.mark.parametrize(
    ("task", "names", "reach"),
    [
        ({}, ["−10 m/s²", "0", "+10 m/s²"], 20.0),
        (
            {"pendulum": STRONG}, ["−20 m/s²", "−10 m/s²", "0", "+10 m/s²", "+20 m/s²"],
            20 * np.sqrt(np.hypot(9.81, 20) / 0.4) / np.sqrt(np.hypot(9.81, 10) / 0.2),
        ),
    ],
)  # fmt: skip
def test_it_has_a_colour_for_each_action_and_shows_as_far(tmp_path, task, names, reach):
    results = folder_of(tmp_path, len(names), **task)
    figure = loading.load("figures", "bound").draw(results).figure
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == names
    own = {patch.get_facecolor() for patch in legend.get_patches()}
    assert len(own) == len(names)
    thesis = next(axes for axes in figure.axes if axes.get_title(loc="left").startswith("Optimal"))
    (mesh,) = thesis.collections
    shown = {tuple(shade) for shade in mesh.to_rgba(mesh.get_array()).reshape(-1, 4)}
    assert shown == own
    assert thesis.get_ylim() == pytest.approx((-reach, reach))
    plt.close(figure)
