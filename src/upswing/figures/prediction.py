"""Prediction by TD and Monte Carlo: how wrong each method is after so many steps (§2.4.3, §2.4.4)."""

from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration
from upswing.optimal.prediction_tables import (
    BAND,
    OF_LIMITS,
    OF_PREDICTION,
    REMEDY,
    SIZE,
    SPREAD,
    VARYING,
)
from upswing.study.paths import PREDICTION, PREDICTION_LIMITS

if TYPE_CHECKING:
    import pandas as pd

    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

FIGURE = Declaration(
    "Prediction: to bootstrap or to wait",
    "§2.4.3, §2.4.4",
    (),
    tables=(PREDICTION, PREDICTION_LIMITS),
)
COLOURS = ("#0072B2", "#3A97D3", "#009E73", "#CC79A7", "#A65628", "#D55E00")
FEWEST = "TD(0)"
"""The method that waits for the fewest rewards before it bootstraps."""

DASHES = {"every-visit Monte Carlo": (0, (4, 2))}
"""Dashed, so that what lies below it is seen: with a small γ, n steps are as good as all."""

FILLED = {"first-visit Monte Carlo": "none"}
"""Hollow, so that the mark of another method is seen in its own."""

BEYOND = 1.6
"""Where the limit of a method is marked: at so many times the last number of steps."""


def draw(results: "Results") -> "Drawing":
    """A panel for each γ and tiles, a line for each method, and where the line goes in the end."""
    from upswing.analysis.colours import of_text
    from upswing.figures import panels
    from upswing.figures.style import WIDTH, subplots
    from upswing.runs.files.typed_table import read_table

    table = read_table(results.folder / PREDICTION, OF_PREDICTION, REMEDY)
    limits = read_table(results.folder / PREDICTION_LIMITS, OF_LIMITS, REMEDY)
    shown = table[table["seeds"] == "shown"]
    methods = list(dict.fromkeys(shown["method"]))
    shades = dict(zip(methods, COLOURS, strict=False))
    problems = list(dict.fromkeys(zip(shown["discount"], shown["tiles"], strict=True)))
    figure, (axes,) = subplots(1, len(problems), figsize=(WIDTH, 2.9), sharex=True, squeeze=False)
    for panel, problem in zip(axes, problems, strict=True):
        of_problem, known = _of(shown, problem), _limits(limits, problem)
        for method in methods:
            one = of_problem[of_problem["method"] == method]
            colour = shades[method]
            panel.loglog(
                one["steps"], one["error"], linestyle=DASHES.get(method, "-"),
                color=colour, linewidth=1.2, label=method,
            )  # fmt: skip
            panel.fill_between(
                one["steps"], one["low"], one["high"], color=colour, alpha=0.15, linewidth=0
            )
        bottom, _ = panel.set_ylim(bottom=0.7 * of_problem["low"].min())
        for method in methods:
            if known[method] > bottom:
                panel.plot(
                    BEYOND * shown["steps"].max(), known[method], "<",
                    color=shades[method], markersize=4.5, fillstyle=FILLED.get(method, "full"),
                )  # fmt: skip
        panel.set_title(f"γ = {problem[0]:g}, {problem[1]:,} tiles")
        panel.set_xlabel("steps")
    axes[0].set_ylabel("error of V [rad²]")
    handles, labels = axes[0].get_legend_handles_labels()
    legend = figure.legend(handles, labels, loc="outside upper center", ncols=3, frameon=False)
    for text, method in zip(legend.get_texts(), methods, strict=True):
        text.set_color(of_text(shades[method]))
    return panels.Drawing(figure, _caption(shown, limits, problems), [], _alt(shown, problems))


def _of(table: "pd.DataFrame", problem: tuple[float, int]) -> "pd.DataFrame":
    return table[(table["discount"] == problem[0]) & (table["tiles"] == problem[1])]


def _limits(limits: "pd.DataFrame", problem: tuple[float, int]) -> dict[str, float]:
    own = _of(limits, problem)
    return dict(zip(own["quantity"], own["value"], strict=True))


def _caption(
    shown: "pd.DataFrame", limits: "pd.DataFrame", problems: list[tuple[float, int]]
) -> str:
    """What is drawn, and what bootstrapping comes to, asked of the tables."""
    far = [problem for problem in problems if problem[0] == problems[-1][0]]
    known = [_limits(limits, problem) for problem in far]
    ends = ", ".join(
        f"{one[FEWEST]:.2f} rad² off with {tiles:,} tiles"
        for (_, tiles), one in zip(far, known, strict=True)
    )
    size, spread, varying = (known[0][quantity] for quantity in (SIZE, SPREAD, VARYING))
    met = ", ".join(f"{method} {error:.2f}" for method, error in _ended(shown, far[0]))
    return (
        "All methods learn from the same episodes of balancing with random actions. The error of a tile "
        "is that against the mean of the exact V of its states; its root mean square over the steps is "
        f"drawn, as the mean over {int(shown['runs'].iloc[0])} seeds and a band of the middle "
        f"{100 * (BAND[1] - BAND[0]):.0f} % of them, each method with the step size that was best on "
        "other seeds. Triangles mark where methods go with ever more steps. What to see with "
        f"γ = {far[0][0]:g}, where V is of the size of {size:.1f} rad²: {FEWEST}, which bootstraps "
        f"most, does not end at the exact values, since a tile hides a part of the state ({ends}). "
        "First visits do not either: they are those states of a tile in which it is entered. For "
        f"comparison, returns of one state vary by {varying:.2f} rad², and V inside one of the "
        f"{far[0][1]:,} tiles by {spread:.2f} rad². Errors there after "
        f"{int(shown['steps'].max()):,} steps [rad²]: {met}."
    )


def _alt(shown: "pd.DataFrame", problems: list[tuple[float, int]]) -> str:
    parts = []
    for problem in problems:
        (most, error), (least, smaller) = (_ended(shown, problem)[end] for end in (-1, 0))
        parts.append(
            f"with γ = {problem[0]:g} and {problem[1]:,} tiles from {smaller:.2g} rad² ({least}) to "
            f"{error:.2g} ({most})"
        )
    return f"Errors of V after {int(shown['steps'].max()):,} steps: {'; '.join(parts)}."


def _ended(shown: "pd.DataFrame", problem: tuple[float, int]) -> list[tuple[str, float]]:
    """Each method with its error [rad²] after all steps, the least first."""
    own = _of(shown, problem)
    last = own[own["steps"] == own["steps"].max()].sort_values("error")
    return list(zip(last["method"], last["error"], strict=True))
