"""Pictures of a run and of a cell for a notebook, from the panels of the study's figures."""

from io import BytesIO
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from PIL import Image

from upswing.analysis.colours import label, shown_as
from upswing.figures import panels
from upswing.figures.appearance import APPEARANCE
from upswing.physics.actions import signed
from upswing.runs.files.trajectory import WHOLE_AT_START
from upswing.runs.recording.actions import UNDECIDED_COLOUR, action_colours
from upswing.runs.results import Ensemble, OneRun, Results

if TYPE_CHECKING:
    from upswing.api.policy import Policy
    from upswing.api.run import Run

WIDTH, ROW = 7.6, 2.1
"""Of a picture, and the height of a row of panels [inch]."""

STATES = (181, 121)
"""Numbers of angles and of velocities at which the policy is asked."""

COLOURS = 64
"""Of a picture in a notebook."""

NAMED = 11
"""Of more actions than these, only some are named beside the map."""

WHOLE_TURN = 180
"""The largest angle of a task that has no end of it [°]."""


class Picture(Figure):
    """A figure that a notebook shows by itself, and that no backend has to draw.

    Matplotlib's own need ``pyplot``, whose settings then are everybody's.
    """

    def _repr_png_(self) -> bytes:
        drawn, small = BytesIO(), BytesIO()
        with mpl.rc_context(APPEARANCE):
            self.savefig(drawn, format="png")
        with Image.open(drawn) as image:  # notebooks are kept: a palette is a third of it
            image.convert("RGB").quantize(COLOURS).save(small, "png", optimize=True)
        return small.getvalue()


def figure_of_run(run: "Run") -> Figure:
    """φ at the beginning and over the whole run, how it learned, and its policy."""
    windows = run.windows
    one = OneRun(run.id, run.task, run.seed, run.trajectory, windows)
    cell = run.spec.cell
    with mpl.rc_context(APPEARANCE):
        picture = Picture(figsize=(WIDTH, 2 * ROW))
        (first, policy), (whole, learning) = picture.subplots(2, 2, width_ratios=(3, 2))
        picture.suptitle(run.id, fontsize=9, x=0.01, ha="left")
        steps = min(WHOLE_AT_START, run.task.steps)
        panels.angle(first, one, cell, steps)
        first.set_title(f"The first {steps:,} steps")
        if run.task.angle_limit < WHOLE_TURN:
            panels.angle(whole, one, cell)
        else:
            panels.angle_histogram(whole, one, cell)
        whole.set_title("The whole run")
        of_policy(policy, run.policy)
        of_learning(learning, cell, _alone(run, windows))
        learning.set_title("How it learned")
    return picture


def figure_of_cell(results: Results, cell: str) -> Figure:
    """φ of the median run, and how all runs of a cell learned."""
    with mpl.rc_context(APPEARANCE), shown_as(results.study, results.architectures):
        picture = Picture(figsize=(WIDTH, ROW))
        left, right = picture.subplots(1, 2, width_ratios=(3, 2))
        picture.suptitle(cell, fontsize=9, x=0.01, ha="left")
        median = results.median_run(cell)
        if median.task.angle_limit < WHOLE_TURN:
            panels.angle(left, median, cell)
        else:
            panels.angle_histogram(left, median, cell)
        left.set_title(f"Median run (seed {median.seed})")
        of_learning(right, cell, results.ensemble(cell), label(cell))
    return picture


def of_learning(axes: Axes, cell: str, runs: Ensemble, label: str = "") -> None:
    """Falls so far, or the share of steps upright: whatever the task is judged by."""
    draw = panels.falls if runs.task.judged_by == "falls" else panels.upright
    draw(axes, [(cell, label, runs)])


def of_policy(axes: Axes, policy: "Policy") -> None:
    """Which acceleration is chosen in which state; grey where several are worth the same."""
    limit = policy.spec.task.angle_limit
    angles = np.linspace(-np.radians(limit), np.radians(limit), STATES[0])
    fastest = policy.learned.setting.encoder.picture.velocity_limit
    velocities = np.linspace(-fastest, fastest, STATES[1])
    accelerations, actions = policy.accelerations, len(policy.accelerations)
    q = np.nan_to_num(policy.values(angles[None, :], velocities[:, None]), neginf=-np.inf)
    equals = (q == q.max(axis=-1, keepdims=True)).sum(axis=-1) > 1
    chosen = np.where(equals, actions, q.argmax(axis=-1))
    shades = (*action_colours(accelerations), UNDECIDED_COLOUR)
    colours: Any = [[part / 255 for part in shade] for shade in shades]
    image = axes.imshow(
        chosen, cmap=ListedColormap(colours), vmin=-0.5, vmax=actions + 0.5, origin="lower",
        aspect="auto", interpolation="nearest",
        extent=(-limit, limit, -fastest, fastest),
    )  # fmt: skip
    axes.grid(visible=False)
    axes.set(xticks=np.linspace(-limit, limit, 5), title="What it learned to do [m/s²]")
    axes.set(xlabel="angle φ [°]", ylabel="φ̇ [rad/s]")
    figure = axes.get_figure(root=True)
    assert figure is not None  # noqa: S101
    named = list(range(0, actions, -(-actions // NAMED)))
    scale = figure.colorbar(image, ax=axes, ticks=[*named, actions])
    scale.ax.set_yticklabels([*(signed(accelerations[each]) for each in named), "equal"])
    scale.outline.set_visible(False)


def _alone(run: "Run", windows: Any) -> Ensemble:
    """A single run as an ensemble of one."""
    last_step = (windows["first_step"] + windows["steps"]).to_numpy(float)
    diverged_at = run.measures["diverged_at"]
    end = np.inf if pd.isna(diverged_at) else float(diverged_at)
    falls, upright = (
        np.where(last_step <= end, windows[name].to_numpy(float), np.nan)[None, :]
        for name in ("falls", "upright_share")
    )
    return Ensemble(run.task, [run.seed], last_step, falls, upright, np.array([np.isfinite(end)]))
