"""What decides a claim, drawn: every run as a dot, and the estimate against the claim's threshold."""

from collections.abc import Sequence
from textwrap import wrap
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec
from matplotlib.ticker import NullLocator

from upswing.analysis.colours import colour, label, of_text
from upswing.analysis.strips import ends
from upswing.figures import interaction
from upswing.figures.appearance import MUTED, SMALL
from upswing.figures.decided import Decided, Row
from upswing.figures.measures import AxisOf, axis_of, threshold_of
from upswing.runs.results import Results
from upswing.study.claim_parts import COUNTED
from upswing.study.ids import CellId

ROW = 0.145
"""Height of a row of dots [inch]."""

TITLE, BELOW = 0.14, 0.42
"""Heights of a line of a title, and of what stands below a panel with the gap to the next [inch]."""

LETTERS = 104
"""Number of letters of a title's line."""

APART = 0.28
"""How far seeds lie apart from the middle of their row, in their order."""

HOLDS = "#DCEFE3"
"""The side on which a claim holds; as on the page."""

LEAST = 0.05
"""How far a scale of differences reaches at least, in the unit of the table."""

DRAWN_AS_DOTS = 60
"""So many dots of a panel are drawn as such; more in pixels."""


class Drawn(NamedTuple):
    """A panel: its runs on the left, its estimates on the right."""

    runs: Axes
    strip: Axes
    texts: list[str]  # what is written at the right of each estimate


def height(decided: Sequence[Decided]) -> float:
    """How high the panels are [inch]."""
    lines = sum(len(_title(one)) for one in decided)
    rows = sum(_rows_of(one) for one in decided)
    return TITLE * lines + ROW * rows + BELOW * len(decided)


def draw(
    figure: Figure, place: SubplotSpec, decided: Sequence[Decided], results: Results
) -> list[Drawn]:
    """Draw a panel for each part of a claim, one below the other."""
    grid = place.subgridspec(
        len(decided), 2, height_ratios=[_rows_of(one) for one in decided], width_ratios=(3, 2)
    )
    cells = [row.dots[0].cell for one in decided for row in one.rows if row.dots]
    task = CellId.parse(cells[0]).task if cells else ""
    drawn = []
    for number, one in enumerate(decided):
        runs, strip = (figure.add_subplot(grid[number, column]) for column in range(2))
        runs.set_title("\n".join(_title(one)), loc="left", fontsize=SMALL + 0.5, pad=3)
        middles = _runs(runs, one, results, task)
        drawn.append(Drawn(runs, strip, _strip(strip, one, middles)))
    return drawn


def _title(decided: Decided) -> list[str]:
    words = f"{decided.claim}: {decided.part.says}".replace("`", "")
    return wrap(words.replace("α = ", "α\u00a0=\u00a0"), LETTERS)


def _rows_of(decided: Decided) -> int:
    return sum(max(1, len(row.dots)) for row in decided.rows)


def _runs(axes: Axes, decided: Decided, results: Results, task: str) -> list[float]:
    """The dots; returns in which row each estimate stands."""
    cells = {dots.cell for row in decided.rows for dots in row.dots}
    scale = axis_of(decided.part, [results.task(cell) for cell in cells])
    many = sum(len(dots.seeds) for row in decided.rows for dots in row.dots) > DRAWN_AS_DOTS
    labels, middles, at = [], [], 0
    for row in decided.rows:
        middles.append(at + (max(1, len(row.dots)) - 1) / 2)
        for dots in row.dots:
            values, shade = scale.factor * dots.values, colour(dots.cell)
            places = at + np.linspace(-APART, APART, len(values))
            axes.scatter(
                values, places, s=3.5, color=shade, alpha=0.35 if row.beside else 0.6, linewidths=0,
                rasterized=many,
            )  # fmt: skip
            interaction.remember(axes, interaction.Dots(dots.cell, dots.seeds, values, places))
            labels.append(_label(dots.cell, results, task))
            at += 1
        if row.counted is not None:
            labels.append("")
            successes, of = row.counted
            unit = COUNTED.get(decided.part.kind, "runs")
            axes.annotate(
                f"{successes} of {of} {unit}", (0.0, at), xycoords=("axes fraction", "data"),
                va="center", fontsize=SMALL,
            )  # fmt: skip
            at += 1
    axes.set_yticks(range(at), labels, fontsize=SMALL)
    axes.set_ylim(at - 0.45, -0.55)
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
    _scaled(axes, decided, scale)
    return middles


def _scaled(axes: Axes, decided: Decided, scale: AxisOf) -> None:
    """The axis of what is measured, with the line from which on a run is counted."""
    axes.tick_params(axis="x", labelsize=SMALL, pad=1)
    if not any(row.dots for row in decided.rows):
        axes.set_xticks([])
        axes.spines[["left", "bottom"]].set_visible(False)
        return
    words = scale.label
    if (threshold := threshold_of(decided.part)) is not None:
        axes.axvline(threshold.at, color=MUTED, linewidth=0.9)
        words = f"{words}; {threshold.words}"
    axes.set_xlabel(words, fontsize=SMALL, labelpad=1)
    if scale.is_count:
        most = max((d.values.max(initial=0) for row in decided.rows for d in row.dots), default=0)
        axes.set_xscale("symlog", linthresh=1)
        axes.set_xlim(-0.2, max(2.0, 1.3 * most))
        ticks = [0, *(10**power for power in range(6) if 10**power <= max(1, most))]
        axes.set_xticks(ticks, [f"{tick:,}" for tick in ticks])
        axes.xaxis.set_minor_locator(NullLocator())
    elif decided.part.paired:
        most = max(
            abs(scale.factor * d.values).max(initial=0) for row in decided.rows for d in row.dots
        )
        axes.set_xlim(-(reach := max(LEAST * scale.factor, 1.1 * most)), reach)
    elif scale.within is not None:
        low, high = scale.within
        axes.set_xlim(low - 0.03 * (high - low), high + 0.03 * (high - low))
        axes.set_xticks(np.linspace(low, high, 5))


def _strip(axes: Axes, decided: Decided, middles: Sequence[float]) -> list[str]:
    """Each estimate with its interval, and the side on which the claim holds."""
    part = decided.part
    known = [row.estimate for row in decided.rows if np.isfinite(row.estimate[:3]).all()]
    values = [x for one in known for x in one[:3]] + [part.threshold, float(part.partly)]
    left, right = ends(values, known[0].method if known else "")
    axes.axvspan(
        *((part.threshold, right) if part.is_lower else (left, part.threshold)), color=HOLDS,
        linewidth=0, zorder=0,
    )  # fmt: skip
    axes.axvline(part.threshold, color=MUTED, linewidth=1.1)
    axes.axvline(float(part.partly), color=MUTED, linewidth=0.9, linestyle=(0, (3, 2)))
    texts = []
    for row, middle in zip(decided.rows, middles, strict=True):
        texts.append(_estimate(axes, row, middle))
    sign = "from" if part.is_lower else "up to"
    axes.set_xlabel(
        f"holds {sign} {part.threshold:g} (partly {sign} {part.partly:g})",
        fontsize=SMALL,
        labelpad=1,
    )
    axes.set_xlim(left, right)
    axes.set_ylim(_rows_of(decided) - 0.45, -0.55)
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="x", labelsize=SMALL, pad=1)
    axes.locator_params(axis="x", nbins=4)
    axes.grid(visible=False)
    return texts


def _estimate(axes: Axes, row: Row, middle: float) -> str:
    estimate = row.estimate
    # Of two cells the first is what the claim is about; of several none is.
    shade = colour(row.dots[0].cell) if 1 <= len(row.dots) <= 2 else "#333333"
    if not estimate.n:
        words = "no runs"
    elif not np.isfinite(estimate[:3]).all():  # a resample may have nothing to divide by
        words = f"{estimate.value:.2f}, no interval"
    else:
        words = f"{estimate.value:.2f} [{estimate.low:.2f}, {estimate.high:.2f}]".replace("-", "−")
        axes.hlines(middle, estimate.low, estimate.high, color=shade, linewidth=2.2, alpha=0.5)
        axes.plot(
            estimate.value, middle, "o", color=shade, markersize=3.8, clip_on=False,
            markerfacecolor="white" if row.beside else shade,
        )  # fmt: skip
    axes.annotate(
        words, (1.03, middle), xycoords=("axes fraction", "data"), va="center", fontsize=SMALL,
        color=MUTED if row.beside else of_text(shade), annotation_clip=False,
    )  # fmt: skip
    return words


def _label(cell: str, results: Results, task: str) -> str:
    """A cell; with the number of its steps where its task is not that of the figure's first."""
    words = label(cell)
    if CellId.parse(cell).task == task:
        return words
    return f"{words}, {results.task(cell).steps:,} steps"
