"""The panels that the figures are made of: one run's angle, and all runs of a cell."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator

from upswing.colours import colour
from upswing.figures.style import grid_of_panels
from upswing.runs import Crowd, OneRun, Real, Results
from upswing.store.trajectory import WHOLE_AT_START

POINTS = 200
"""A crowd's line has about so many points."""


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
        degrees = np.degrees(shown["angle"].to_numpy(float))
        degrees[1:][shown["reset"].to_numpy()[:-1]] = np.nan  # no line across a reset
        axes.plot(shown["step"], degrees, color=colour(cell), linewidth=0.6)
        last = steps
    else:
        first = run.windows["first_step"].to_numpy(float)
        last = int(first[-1] + run.windows["steps"].iloc[-1])
        middles = np.repeat(first + run.windows["steps"].to_numpy(float) / 2, 2)
        extremes = np.degrees(run.windows[["lowest_angle", "highest_angle"]].to_numpy(float))
        axes.plot(middles, extremes.ravel(), color=colour(cell), linewidth=0.6)
    limit = 90 if run.kind == "balancing" else 180
    axes.set(ylim=(-1.08 * limit, 1.08 * limit), yticks=np.linspace(-limit, limit, 5))
    axes.set(xlim=(0, last), ylabel="angle φ [°]", title=f"Median run (seed {run.seed})")
    _steps_axis(axes)


def falls(axes: Axes, crowds: Sequence[tuple[str, str, Crowd]], steps: int | None = None) -> None:
    """Falls so far over the steps: every run of the first cell, and the median of each cell.

    Args:
        axes: where to draw.
        crowds: (cell, label, its runs) of each cell; all runs are drawn of the first.
        steps: draw only so many first steps.
    """
    _crowd(axes, [(cell, label, c.last_step, c.falls_so_far) for cell, label, c in crowds], steps)
    axes.set(ylabel="falls so far", title=f"All {len(crowds[0][2].seeds)} runs")
    axes.set_ylim(bottom=0)


def upright(axes: Axes, crowds: Sequence[tuple[str, str, Crowd]]) -> None:
    """The share of steps with |φ| ≤ 20° over the steps; see ``falls``."""
    lines = []
    for cell, label, crowd in crowds:
        group = max(1, crowd.upright_share.shape[1] // 100)
        whole = crowd.upright_share.shape[1] // group * group
        means = crowd.upright_share[:, :whole].reshape(len(crowd.seeds), -1, group).mean(axis=2)
        lines.append((cell, label, crowd.last_step[group - 1 : whole : group], 100 * means))
    _crowd(axes, lines, None)
    axes.set(ylabel="upright [% of steps]", title=f"All {len(crowds[0][2].seeds)} runs")
    axes.set(ylim=(-4, 104), yticks=(0, 25, 50, 75, 100))


def one_and_all(
    results: Results, cells: Sequence[tuple[str, str]], beside: Sequence[tuple[str, str]] = ()
) -> tuple[Figure, list[OneRun]]:
    """A row for each of ``cells`` (id, label): its median run's angle, and all its runs.

    Args:
        results: what is drawn.
        cells: ids and labels of the cells.
        beside: cells whose medians are drawn beside the crowds, for comparison.
    """
    figure, panels = grid_of_panels(len(cells))
    shown = []
    compared = [(cell, label, results.crowd(cell)) for cell, label in beside]
    for row, (cell, label) in enumerate(cells):
        left, right = panels[2 * row : 2 * row + 2]
        shown.append(results.median_run(cell))
        angle(left, shown[-1], cell)
        crowd = results.crowd(cell)
        all_runs = falls if crowd.kind == "balancing" else upright
        all_runs(right, [(cell, label, crowd), *compared])
        if len(cells) > 1:
            left.set_title(f"{label}: {left.get_title(loc='left').lower()}", loc="left")
    return figure, shown


def _crowd(axes: Axes, lines: Sequence[tuple[str, str, Real, Real]], steps: int | None) -> None:
    """Lines of all runs of the first cell, thin, and medians of all cells, thick and labelled."""
    ends = []
    for number, (cell, label, last_step, values) in enumerate(lines):
        within = (
            len(last_step) if steps is None else int(np.searchsorted(last_step, steps, "right"))
        )
        every = max(1, within // POINTS)
        x, y = last_step[:within:every], values[:, :within:every]
        if number == 0:
            axes.plot(x, y.T, color=colour(cell), linewidth=0.4, alpha=0.35)
        median = np.median(y, axis=0)
        style = "-" if number == 0 else "--"
        axes.plot(x, median, style, color=colour(cell), linewidth=1.8 if number == 0 else 1.2)
        ends.append((float(median[-1]), label, colour(cell)))
    axes.set_xlim(0, steps or float(lines[0][2][-1]))
    _steps_axis(axes)
    _label_ends(axes, ends)


def _label_ends(axes: Axes, ends: Sequence[tuple[float, str, str]]) -> None:
    """Name each median at its right end, moved apart where they would overlap."""
    low, high = axes.get_ylim()
    gap = 0.12 * (high - low)
    place = -np.inf
    for value, label, shade in sorted(ends):
        place = max(value, place + gap)
        axes.annotate(
            label, (1.02, place), xycoords=("axes fraction", "data"), color=shade, va="center",
            annotation_clip=False,
        )  # fmt: skip


def _steps_axis(axes: Axes) -> None:
    axes.xaxis.set_major_formatter(FuncFormatter(_short))
    axes.xaxis.set_major_locator(MaxNLocator(4))
    axes.set_xlabel("step of 5 ms")


def _short(value: float, _: int) -> str:
    """A number of steps, written short: 500, 15k, 2.5M."""
    for size, letter in ((1e6, "M"), (1e3, "k")):
        if value >= size:
            return f"{value / size:g}{letter}"
    return f"{value:g}"
