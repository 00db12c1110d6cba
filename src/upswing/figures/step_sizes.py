"""How many runs succeed with each step size: claims C3, C6 and C8 in one picture."""

from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

FIGURE = Declaration("What the step size decides", "", ("C3", "C6", "C8", "C11"))
APART = 1.1
"""How far architectures stand apart, as a factor of α."""


def draw(results: "Results") -> "Drawing":
    """A panel for each task: the share of runs that succeed over α, a line for each architecture."""
    from upswing.analysis.colours import colour
    from upswing.figures import panels, told
    from upswing.figures.captions import succeeding
    from upswing.figures.lengths import end_of
    from upswing.figures.style import dashes, filled, grid_of_panels
    from upswing.figures.success_share import share
    from upswing.runs.success import SUCCESS

    curves: dict[tuple[str, str], dict[float, str]] = {}
    for cell, spec in results.cells.items():
        if spec.alpha is not None:
            key = (spec.task.name, spec.architecture.name)
            curves.setdefault(key, {})[float(spec.alpha)] = cell
    tasks = list(dict.fromkeys(task for task, _ in curves))
    shown = [task for task in tasks if any(len(c) > 1 for (t, _), c in curves.items() if t == task)]
    shown = (shown or tasks)[:2]
    figure, axes = grid_of_panels(1, (1, 1), height=2.6)
    for panel, task in zip(axes, shown, strict=False):
        ends: list[tuple[float, str, str]] = []
        own = [(of, cells) for (on, of), cells in curves.items() if on == task]
        for number, (architecture, cells) in enumerate(own):
            alphas = sorted(cells)
            # Architectures stand a little apart, so that equal ones are both seen.
            beside = [alpha * APART ** (number - (len(own) - 1) / 2) for alpha in alphas]
            found = [share(results, cells[alpha]) for alpha in alphas]
            first = cells[alphas[0]]
            shade = colour(first)
            low, high = ([getattr(s, end) - s.value for s in found] for end in ("low", "high"))
            panel.errorbar(
                beside, [s.value for s in found], yerr=[[-x for x in low], high], color=shade,
                fmt="o", linestyle=dashes(first), markersize=3.5, linewidth=1.4, elinewidth=1,
                capsize=2, markerfacecolor=shade if filled(first) else "white",
            )  # fmt: skip
            ends.append((found[-1].value, architecture, shade))
        panel.set_xscale("log")
        panel.xaxis.set_major_formatter("{x:g}")
        panel.set(ylim=(-4, 104), yticks=(0, 25, 50, 75, 100), xlabel="step size α")
        criterion = (
            "without a fall in the last fifth"
            if results.study.tasks[task].judged_by == "falls"
            else "that stand at the end"
        )
        panel.set_title(f"{task}: runs {criterion} [%]")
        panels.label_ends(panel, ends)
    for panel in axes[len(shown) :]:
        panel.set_visible(False)
    several = {key: cells for key, cells in curves.items() if key[0] in shown and len(cells) > 1}
    seen = "; ".join(told.over_alpha(results, *key, cells) for key, cells in several.items())
    every = [spec.task for spec in results.cells.values()]
    done = {
        "falls": "balancing without a fall in the last fifth",
        "upright": f"full control upright for {100 * SUCCESS:.0f} % of the last {end_of(every)}",
    }
    caption = (
        "The share of runs that succeed, with its 95 % interval (Wilson), over the step size α: "
        f"{succeeding(every, done)}. Architectures stand a little apart, and "
        f"modular ones are hollow and dashed.{f' What to see: {seen}.' if seen else ''}"
    )
    return panels.Drawing(figure, caption, [], f"{seen[0].upper()}{seen[1:]}." if seen else "")
