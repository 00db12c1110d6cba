"""Pictures of a run and of a cell: what stands in them, and that they change nobody's settings."""

from io import BytesIO

import matplotlib as mpl
import numpy as np
import pytest
from PIL import Image

import upswing


@pytest.mark.parametrize(
    "name", ["balancing/table/alpha-0.1/seed-1", "full-control/modular-networks-5/alpha-1/seed-2"]
)
def test_a_run_is_shown_in_four_panels(study, name):
    one = study.run(name)
    figure = one.plot()
    first, policy, _, learning, scale = figure.axes
    assert figure.get_suptitle() == name
    assert first.get_title(loc="left") == "The first 5,000 steps"
    assert [label.get_text() for label in scale.get_yticklabels()] == ["−10", "0", "+10", "equal"]
    # The map is the policy, state by state.
    (image,) = policy.images
    chosen = image.get_array()
    left, right, low, high = image.get_extent()
    draws = np.random.default_rng(0)
    for row, column in zip(draws.integers(chosen.shape[0], size=40), draws.integers(chosen.shape[1], size=40), strict=True):  # fmt: skip
        angle = np.linspace(np.radians(left), np.radians(right), chosen.shape[1])[column]
        velocity = np.linspace(low, high, chosen.shape[0])[row]
        q = one.values(angle, velocity)
        best = np.flatnonzero(q == q.max())
        assert chosen[row, column] == (best[0] if len(best) == 1 else 3)
    drawn = learning.lines[0].get_ydata()
    if one.task.judged_by == "falls":
        assert drawn[-1] <= one.measures["falls"] == one.windows["falls"].sum()
        assert drawn[-1] >= one.windows["falls"].iloc[:-10].sum()
    else:
        assert drawn.max() <= 100


def test_a_run_learned_here_is_shown_too():
    short = upswing.train("balancing", "table", 0.5, steps=300)
    assert short.plot().axes[0].get_title(loc="left") == "The first 300 steps"


def test_the_map_is_of_the_run_s_own_actions_and_velocities():
    own = upswing.train(
        {"kind": "full-control", "tiles": {"velocity_limit": 14}}, "table", 0.5, steps=300,
        pendulum={"length": 0.4, "accelerations": [-20, -10, 0, 10, 20]},
    )  # fmt: skip
    _, policy, *_, scale = own.plot().axes
    assert policy.images[0].get_extent() == [-180, 180, -14, 14]
    names = [label.get_text() for label in scale.get_yticklabels()]
    assert names == ["−20", "−10", "0", "+10", "+20", "equal"]
    shades = policy.images[0].cmap(range(6))[:, :3] * 255
    np.testing.assert_allclose(shades[[0, 2, 4]], [(0, 114, 178), (221, 221, 221), (213, 94, 0)])
    assert len(np.unique(shades.round(), axis=0)) == 6


def test_of_many_actions_some_are_named():
    many = upswing.train(
        "full-control", "table", 0.5, steps=300, pendulum={"accelerations": [*range(-10, 11)]}
    )
    scale = many.plot().axes[-1]
    names = [label.get_text() for label in scale.get_yticklabels()]
    assert names == [f"−{n}" for n in range(10, 0, -2)] + ["0"] + [
        f"+{n}" for n in range(2, 11, 2)
    ] + ["equal"]  # fmt: skip


def test_a_run_that_diverged_is_shown():
    one = upswing.train(
        "full-control", "networks-30", 1, steps=6_000,
        readings={
            "reward_unit": "degrees", "learning_rate": 1, "initial_weights": 1, "biases": "both",
        },
    )  # fmt: skip
    assert 0 < one.measures["diverged_at"] < 6_000
    figure = one.plot()
    marks = [line for line in figure.axes[3].lines if line.get_marker() == "x"]
    assert len(marks) == 1
    assert figure._repr_png_()


def test_a_cell_is_shown_with_all_its_runs(study):
    left, right = study.cell("balancing/table/alpha-1").plot().axes
    assert left.get_title(loc="left").startswith("Median run (seed ")
    assert right.get_title(loc="left") == "All 3 runs"
    assert len(right.lines) == 4  # the runs and their median


def test_a_notebook_shows_it_without_a_backend_and_settings_stay(study):
    before, backend = dict(mpl.rcParams), mpl.get_backend(auto_select=False)
    figure = study.run("balancing/table/alpha-0.1/seed-1").plot()
    content = figure._repr_png_()
    with Image.open(BytesIO(content)) as picture:
        assert picture.size == (760, 420)
    assert len(content) < 100_000
    assert dict(mpl.rcParams) == before
    assert mpl.get_backend(auto_select=False) == backend
