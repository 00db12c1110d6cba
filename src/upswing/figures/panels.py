"""The panels that the figures are made of: one run's angle, and all runs of a cell."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from upswing.analysis.colours import colour
from upswing.runs.files.trajectory import THINNED, WHOLE_AT_START
from upswing.runs.results import Ensemble, OneRun, Real

POINTS = 200
"""Approximate number of points of an ensemble's line."""

MANY = 40
"""So many lines are drawn in pixels: as lines they would be most of the page."""

EVERY = 2
"""Which of the first steps are drawn: every so-many-th, and those with a fall."""

LINE = 0.14
"""Height of a label [inch]."""

ANGLES, TIMES = 37, 125
"""Numbers of bins of an angle histogram, over a turn (0° in the middle of one) and over a run."""


class Drawing(NamedTuple):
    """A figure and its words."""

    figure: Figure
    caption: str
    runs: list[str]  # the single runs that it shows


def angle(axes: Axes, run: OneRun, cell: str, steps: int | None = None) -> None:
    """φ over the steps of one run, as the thesis shows it; of the first ``steps`` only, if given.

    A short stretch is drawn step by step. Of a long one each window's lowest and highest angle: what
    a line through every step would fill.
    """
    if steps is not None and steps <= WHOLE_AT_START:
        shown = run.trajectory[run.trajectory["step"] < steps]
        shown = shown[(shown["step"] % EVERY == 0) | shown["reset"]]
        degrees = np.degrees(shown["angle"].to_numpy(float))
        degrees[1:][shown["reset"].to_numpy()[:-1]] = np.nan  # no line across a reset
        axes.plot(shown["step"], degrees, color=colour(cell), linewidth=0.6)
        last = steps
    else:
        first = run.windows["first_step"].to_numpy(float)
        last = int(first[-1] + run.windows["steps"].iloc[-1])
        begins = np.arange(0, len(first), 2)
        lowest = np.minimum.reduceat(run.windows["lowest_angle"].to_numpy(float), begins)
        highest = np.maximum.reduceat(run.windows["highest_angle"].to_numpy(float), begins)
        middles = np.repeat(first[begins] + run.windows["steps"].iloc[0], 2)
        extremes = np.degrees(np.stack([lowest, highest], axis=1))
        axes.plot(middles, extremes.ravel(), color=colour(cell), linewidth=0.6)
    limit = run.task.angle_limit
    axes.set(ylim=(-1.08 * limit, 1.08 * limit), yticks=np.linspace(-limit, limit, 5))
    axes.set(xlim=(0, last), ylabel="angle φ [°]", title=f"Median run (seed {run.seed})")
    steps_axis(axes)


def angle_histogram(axes: Axes, run: OneRun, cell: str) -> None:
    """Where the pendulum was, in time: the share of steps at each angle, darker for more.

    A line would fill the panel. The steps are those kept evenly over the run; a column's darkest shade
    is three quarters of its steps.
    """
    total = int(run.trajectory["step"].iloc[-1]) + 1
    evenly = run.trajectory[run.trajectory["step"] % max(1, total // THINNED) == 0]
    turns = np.degrees(evenly["angle"].to_numpy(float))
    share, _, _ = np.histogram2d(
        (turns + 180) % 360 - 180,
        evenly["step"],
        bins=(np.linspace(-180, 180, ANGLES + 1), np.linspace(0, total, TIMES + 1)),
    )
    share /= np.maximum(share.sum(axis=0), 1)
    shades = LinearSegmentedColormap.from_list("shades", ["white", colour(cell), "black"])
    axes.imshow(
        share, cmap=shades, vmin=0, vmax=0.75, origin="lower", aspect="auto",
        extent=(0, total, -180, 180), interpolation="nearest",
    )  # fmt: skip
    axes.grid(visible=False)
    axes.set(ylim=(-180, 180), yticks=(-180, -90, 0, 90, 180), xlim=(0, total))
    axes.set(ylabel="angle φ [°]", title=f"Seed {run.seed}")
    steps_axis(axes)


def falls(
    axes: Axes, ensembles: Sequence[tuple[str, str, Ensemble]], steps: int | None = None
) -> None:
    """Falls so far over the steps: every run of the first cell, and the median of each cell.

    Args:
        axes: where to draw.
        ensembles: (cell, label, its runs) of each cell; all runs are drawn of the first.
        steps: number of first steps to draw; all without it.
    """
    _ensemble(
        axes, [(cell, label, c.last_step, c.falls_so_far) for cell, label, c in ensembles], steps
    )
    axes.set(ylabel="falls so far", title=f"All {len(ensembles[0][2].seeds)} runs")
    axes.set_ylim(bottom=0)


def upright(axes: Axes, ensembles: Sequence[tuple[str, str, Ensemble]]) -> None:
    """The share of steps with |φ| ≤ 20° over the steps; see ``falls``."""
    lines = []
    for cell, label, ensemble in ensembles:
        group = max(1, ensemble.upright_share.shape[1] // 100)
        whole = ensemble.upright_share.shape[1] // group * group
        means = (
            ensemble.upright_share[:, :whole].reshape(len(ensemble.seeds), -1, group).mean(axis=2)
        )
        lines.append((cell, label, ensemble.last_step[group - 1 : whole : group], 100 * means))
    _ensemble(axes, lines, None)
    axes.set(ylabel="upright [% of steps]", title=f"All {len(ensembles[0][2].seeds)} runs")
    axes.set(ylim=(-4, 104), yticks=(0, 25, 50, 75, 100))


def _ensemble(axes: Axes, lines: Sequence[tuple[str, str, Real, Real]], steps: int | None) -> None:
    """Lines of all runs of the first cell, thin, and medians of all cells, thick and labelled."""
    ends = []
    for number, (cell, label, last_step, values) in enumerate(lines):
        within = (
            len(last_step) if steps is None else int(np.searchsorted(last_step, steps, "right"))
        )
        every = max(1, within // POINTS)
        x, y = last_step[:within:every], values[:, :within:every]
        if number == 0:
            axes.plot(
                x, y.T, color=colour(cell), linewidth=0.4, alpha=0.35, rasterized=len(y) > MANY
            )
            mark_divergence(axes, x, y)
        finite = ~np.isnan(y).any(axis=1)
        median = np.median(y[finite], axis=0) if finite.any() else np.full(len(x), np.nan)
        style = "-" if number == 0 else "--"
        axes.plot(x, median, style, color=colour(cell), linewidth=1.8 if number == 0 else 1.2)
        lost = int((~finite).sum())
        words = f"{label} ({lost} diverged)" if lost else label
        ends.append((float(median[-1]) if finite.any() else 0.0, words, colour(cell)))
    axes.set_xlim(0, steps or float(lines[0][2][-1]))
    steps_axis(axes)
    label_ends(axes, ends)


def mark_divergence(axes: Axes, x: Real, y: Real) -> None:
    """A cross where the line of a run that diverged ends, shape (runs, points)."""
    for line in y[np.isnan(y).any(axis=1)]:
        known = np.flatnonzero(~np.isnan(line))
        at = known[-1] if len(known) else 0
        value = line[at] if len(known) else 0.0
        axes.plot(x[at], value, "x", color="black", markersize=4, markeredgewidth=0.9, alpha=0.6)


def label_ends(axes: Axes, ends: Sequence[tuple[float, str, str]]) -> None:
    """Name each median at its right end, moved apart where they would overlap."""
    low, high = axes.get_ylim()
    whole = axes.get_figure(root=True)
    assert whole is not None  # noqa: S101
    inches = whole.get_size_inches()[1] * axes.get_position().height
    gap = LINE / inches * (high - low)
    ordered = sorted(ends)
    places: list[float] = []
    for value, _, _ in ordered:
        places.append(max(value, places[-1] + gap if places else value))
    for number in reversed(range(len(places))):  # and none above the panel
        places[number] = min(places[number], high - gap * (len(places) - 1 - number))
    for place, (_, label, shade) in zip(places, ordered, strict=True):
        axes.annotate(
            label, (1.02, place), xycoords=("axes fraction", "data"), color=shade, va="center",
            annotation_clip=False,
        )  # fmt: skip


def steps_axis(axes: Axes) -> None:
    """An axis of steps, written short."""
    axes.xaxis.set_major_formatter(FuncFormatter(_short))
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.set_xlabel("step of 5 ms")


def _short(value: float, _: int) -> str:
    """A number of steps, written short: 500, 15k, 2.5M."""
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if value >= size:
            return f"{value / size:g}{letter}"
    return f"{value:g}"
