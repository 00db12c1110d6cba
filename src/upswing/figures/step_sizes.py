"""How many runs succeed with each step size: claims C3, C6 and C8 in one picture."""

from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

FIGURE = Declaration("What the step size decides", "", ("C3", "C6", "C8", "C11"))


def draw(results: "Results") -> "Drawing":
    """A panel for each task: the share of runs that succeed over α, a line for each architecture."""
    from upswing.figures import panels, told
    from upswing.figures.captions import succeeding
    from upswing.figures.lengths import end_of
    from upswing.figures.over_alpha import success_over_alpha, title_of
    from upswing.figures.style import grid_of_panels
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
        own = {of: cells for (on, of), cells in curves.items() if on == task}
        success_over_alpha(panel, results, own)
        panel.set_title(title_of(results.study.tasks[task], task))
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
