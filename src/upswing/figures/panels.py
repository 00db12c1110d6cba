"""The panels that the figures are made of: one run's angle, and all runs of a cell."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure

from upswing.analysis.colours import colour
from upswing.figures.appearance import SMALL
from upswing.figures.interaction import Alone, Curves, remember
from upswing.figures.labels import angle_axis
from upswing.figures.labels import label_ends as label_ends
from upswing.figures.labels import steps_axis as steps_axis
from upswing.figures.phases import Phase, longest_within, phases
from upswing.runs.files.trajectory import THINNED, WHOLE_AT_START
from upswing.runs.results import Ensemble, OneRun, Real

POINTS = 200
"""Approximate number of points of an ensemble's line."""

MANY = 40
"""So many lines are drawn in pixels: as lines they would be most of the page."""

EVERY = 2
"""Which of the first steps are drawn: every so-many-th, and those with a fall."""

ANGLES, TIMES = 40, 125
"""Numbers of bins of an angle histogram, over a turn (0° and 180° amid one) and over a run."""

TURN = (-90 - 180 / ANGLES, 270 - 180 / ANGLES)
"""The ends of the axis of a whole turn [°]: hanging, 180°, is not cut."""

OFF = 36
"""How far the name of a phase stands from its angle, for a turn [°]."""

IN_MOTION = 54
"""Where what swings and spins is named [°]: below what swings, which reaches upright nowhere."""

HALF_A_NAME, BESIDE = 0.09, 0.2
"""Half the width of the longest name of a phase, and how far apart two are, as parts of a run."""

ON_SHADES: Any = {"facecolor": "white", "alpha": 0.8, "linewidth": 0, "pad": 0.6}
"""What makes a name readable on shades."""

LONG = 0.15
"""The part of a picture from which on it is said that the pendulum stands, where it can fall."""


class Drawing(NamedTuple):
    """A figure and its words."""

    figure: Figure
    caption: str
    runs: list[str]  # the single runs that it shows
    alt: str = ""  # what came out, for who does not see it; without, the title


def angle(axes: Axes, run: OneRun, cell: str, steps: int | None = None) -> None:
    """φ over the steps of one run, as the thesis shows it; of the first ``steps`` only, if given.

    A short stretch is drawn step by step. Of a long one each window's lowest and highest angle: what
    a line through every step would fill.
    """
    if steps is not None and steps <= WHOLE_AT_START:
        shown = run.trajectory[run.trajectory["step"] < steps]
        shown = shown[(shown["step"] % EVERY == 0) | shown["reset"]]
        degrees = np.degrees(shown["angle"].to_numpy(float))
        begins = np.searchsorted(shown["step"], np.linspace(0, steps, TIMES, endpoint=False))
        begins = np.unique(begins[begins < len(degrees)])
        low, high = np.minimum.reduceat(degrees, begins), np.maximum.reduceat(degrees, begins)
        degrees[1:][shown["reset"].to_numpy()[:-1]] = np.nan  # no line across a reset
        axes.plot(shown["step"], degrees, color=colour(cell), linewidth=0.6)
        last = steps
    else:
        first = run.windows["first_step"].to_numpy(float)
        last = int(first[-1] + run.windows["steps"].iloc[-1])
        begins = np.arange(0, len(first), 2)
        low, high = (
            np.degrees(extreme.reduceat(run.windows[name].to_numpy(float), begins))
            for extreme, name in ((np.minimum, "lowest_angle"), (np.maximum, "highest_angle"))
        )
        middles = np.repeat(first[begins] + run.windows["steps"].iloc[0], 2)
        axes.plot(middles, np.stack([low, high], axis=1).ravel(), color=colour(cell), linewidth=0.6)
    remember(axes, Alone(cell, run.seed))
    limit = run.task.angle_limit
    axes.set(ylim=(-1.08 * limit, 1.08 * limit), yticks=np.linspace(-limit, limit, 5))
    angle_axis(axes)
    axes.set(xlim=(0, last), title=f"Median run (seed {run.seed})")
    begin, end = longest_within(low, high)
    if end - begin >= LONG * len(low):
        _name(axes, "stands", (begin + end) / 2 / len(low) * last, 0.6 * limit)
    steps_axis(axes, [run.task])


def angle_histogram(axes: Axes, run: OneRun, cell: str) -> list[Phase]:
    """Where the pendulum was, in time: the share of steps at each angle, darker for more.

    A line would fill the panel. The steps are those kept evenly over the run; a column's darkest shade
    is three quarters of its steps. What lasts is named, where it lasts longest.

    Returns:
        The phases that it names.
    """
    total = int(run.trajectory["step"].iloc[-1]) + 1
    evenly = run.trajectory[run.trajectory["step"] % max(1, total // THINNED) == 0]
    degrees = np.degrees(evenly["angle"].to_numpy(float))
    share, _, _ = np.histogram2d(
        (degrees - TURN[0]) % 360 + TURN[0],
        evenly["step"],
        bins=(np.linspace(*TURN, ANGLES + 1), np.linspace(0, total, TIMES + 1)),
    )
    share /= np.maximum(share.sum(axis=0), 1)
    shades = LinearSegmentedColormap.from_list("shades", ["white", colour(cell), "black"])
    axes.imshow(
        share, cmap=shades, vmin=0, vmax=0.75, origin="lower", aspect="auto",
        extent=(0, total, *TURN), interpolation="nearest",
    )  # fmt: skip
    remember(axes, Alone(cell, run.seed))
    axes.grid(visible=False)
    axes.set(ylim=TURN, yticks=(0, 90, 180), xlim=(0, total))
    angle_axis(axes)
    axes.set_title(f"Seed {run.seed}")
    steps_axis(axes, [run.task])
    found = phases(
        degrees, evenly["angular_velocity"].to_numpy(float), evenly["step"].to_numpy(float) / total,
        run.task.pendulum,
    )  # fmt: skip
    named = _apart(found)
    for phase, (when, where) in named:
        _name(axes, phase.name, when * total, where, bbox=ON_SHADES)
    return [phase for phase, _ in named]


def _apart(found: Sequence[Phase]) -> list[tuple[Phase, tuple[float, float]]]:
    """Phases with the places of their names, as parts of the run and in degrees; none over another."""
    placed: list[tuple[Phase, tuple[float, float]]] = []
    for phase in found:
        when = min(max((phase.first + phase.last) / 2, HALF_A_NAME), 1 - HALF_A_NAME)
        middle = {0.0: OFF, 180.0: 180 - OFF}.get(phase.angle, phase.angle - OFF)
        if phase.name in ("spins", "swings"):
            middle = IN_MOTION
        if all(abs(when - x) > BESIDE or abs(middle - y) >= OFF for _, (x, y) in placed):
            placed.append((phase, (when, middle)))
    return placed


def _name(axes: Axes, name: str, step: float, degrees: float, **more: Any) -> None:
    """Write the name of a phase on the picture."""
    axes.text(
        step, degrees, name, ha="center", va="center", fontsize=SMALL, color="#333333", **more
    )


def falls(
    axes: Axes, ensembles: Sequence[tuple[str, str, Ensemble]], steps: int | None = None
) -> None:
    """Falls so far over the steps: every run of the first cell, and the median of each cell.

    Args:
        axes: where to draw.
        ensembles: (cell, label, its runs) of each cell; all runs are drawn of the first.
        steps: number of first steps to draw; all without it.
    """
    lines = [(cell, label, c.last_step, c.falls_so_far) for cell, label, c in ensembles]
    ends = _ensemble(axes, lines, steps)
    steps_axis(axes, [one.task for _, _, one in ensembles])
    _remember(axes, ensembles, lines)
    axes.set(ylabel="falls so far", title=f"All {len(ensembles[0][2].seeds)} runs")
    axes.set_ylim(bottom=0)
    label_ends(axes, ends)


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
    ends = _ensemble(axes, lines, None)
    steps_axis(axes, [one.task for _, _, one in ensembles])
    _remember(axes, ensembles, lines)
    axes.set(ylabel="upright [% of steps]", title=f"All {len(ensembles[0][2].seeds)} runs")
    axes.set(ylim=(-4, 104), yticks=(0, 25, 50, 75, 100))
    label_ends(axes, ends)


def _ensemble(
    axes: Axes, lines: Sequence[tuple[str, str, Real, Real]], steps: int | None
) -> list[tuple[float, str, str]]:
    """Lines of all runs of the first cell, thin, and medians of all cells, thick.

    Returns:
        Where each median ends, its label and its colour.
    """
    ends = []
    for number, (cell, label, last_step, values) in enumerate(lines):
        within = (
            len(last_step) if steps is None else int(np.searchsorted(last_step, steps, "right"))
        )
        every = max(1, within // POINTS)
        shown = slice((within - 1) % every, within, every)  # with the last one
        x, y = last_step[shown], values[:, shown]
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
    return ends


def _remember(
    axes: Axes,
    ensembles: Sequence[tuple[str, str, Ensemble]],
    lines: Sequence[tuple[str, str, Real, Real]],
) -> None:
    """Which run each line is; those of the first cell are drawn, the others when they are pointed at."""
    for (cell, _, ensemble), (_, _, x, y) in zip(ensembles, lines, strict=True):
        remember(axes, Curves(cell, ensemble.seeds, x, y, drawn=cell == lines[0][0]))


def mark_divergence(axes: Axes, x: Real, y: Real) -> None:
    """A cross where the line of a run that diverged ends, shape (runs, points)."""
    for line in y[np.isnan(y).any(axis=1)]:
        known = np.flatnonzero(~np.isnan(line))
        at = known[-1] if len(known) else 0
        value = line[at] if len(known) else 0.0
        axes.plot(x[at], value, "x", color="black", markersize=4, markeredgewidth=0.9, alpha=0.6)
