"""A panel over the step size: the share of runs that succeed, a line for each architecture."""

from collections.abc import Mapping

from matplotlib.axes import Axes
from matplotlib.ticker import NullFormatter

from upswing.analysis.colours import colour, name_of
from upswing.figures.labels import label_ends
from upswing.figures.style import dashes, filled
from upswing.figures.success_share import share
from upswing.runs.results import Results
from upswing.study.task import Task

APART = 1.1
"""How far architectures stand apart, as a factor of α."""

DECADES = 99
"""Below so large a ratio of step sizes each of them is marked, and above it powers of ten."""

CRITERION = {"falls": "without a fall in the last fifth", "upright": "that stand at the end"}
"""What a success is, by how a task is judged."""


def success_over_alpha(
    axes: Axes, results: Results, cells_of: Mapping[str, Mapping[float, str]]
) -> None:
    """Draw the share of runs that succeed, with its interval.

    Args:
        axes: where to draw.
        results: whose runs.
        cells_of: the cells by their α, of each architecture.
    """
    ends: list[tuple[float, str, str]] = []
    for number, (architecture, cells) in enumerate(cells_of.items()):
        alphas = sorted(cells)
        # Architectures stand a little apart, so that equal ones are both seen.
        beside = [alpha * APART ** (number - (len(cells_of) - 1) / 2) for alpha in alphas]
        found = [share(results, cells[alpha]) for alpha in alphas]
        first = cells[alphas[0]]
        shade = colour(first)
        low, high = ([getattr(s, end) - s.value for s in found] for end in ("low", "high"))
        axes.errorbar(
            beside, [s.value for s in found], yerr=[[-x for x in low], high], color=shade,
            fmt="o", linestyle=dashes(first), markersize=3.5, linewidth=1.4, elinewidth=1,
            capsize=2, markerfacecolor=shade if filled(first) else "white",
        )  # fmt: skip
        ends.append((found[-1].value, name_of(architecture), shade))
    axes.set_xscale("log")
    axes.xaxis.set_major_formatter("{x:g}")
    axes.xaxis.set_minor_formatter(NullFormatter())
    drawn = sorted({alpha for cells in cells_of.values() for alpha in cells})
    if len(drawn) > 1 and drawn[-1] < DECADES * drawn[0]:
        axes.set_xticks(drawn)  # a power of ten or two would be all that is marked
    axes.set(ylim=(-4, 104), yticks=(0, 25, 50, 75, 100), xlabel="step size α")
    label_ends(axes, ends)


def title_of(task: Task, name: str) -> str:
    """What is drawn of a task, for over the panel."""
    return f"{name}: runs {CRITERION[task.judged_by]} [%]"
