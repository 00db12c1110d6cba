"""Learning curves: how often the pendulum falls, or is upright, as training goes on."""

from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

FIGURE = Declaration("Learning curves", "", ("C1", "C4", "C5", "C10", "C12"))
WINDOWS = 40
"""Number of points of a curve."""


def draw(results: "Results") -> "Drawing":
    """Panels for the first task of each way of judging: medians of cells, with their quartiles."""
    import numpy as np

    from upswing.analysis.colours import colour
    from upswing.figures import panels
    from upswing.figures.style import grid_of_panels
    from upswing.figures.success_share import share
    from upswing.study.ids import CellId

    figure, axes = grid_of_panels(2, (3, 2), height=2.4)
    for number, judged_by in enumerate(("falls", "upright")):
        tasks = [
            spec.task.name for spec in results.cells.values() if spec.task.judged_by == judged_by
        ]
        task = tasks[0] if tasks else ""
        cells = [cell for cell, spec in results.cells.items() if spec.task.name == task]
        # Of each architecture the step size with most successes, and with α = 1 if that is another.
        chosen: dict[str, str] = {}
        for cell in cells:
            architecture = CellId.parse(cell).architecture
            best = chosen.get(architecture)
            if best is None or share(results, cell).successes > share(results, best).successes:
                chosen[architecture] = cell
        groups = {
            "best α": list(chosen.values()),
            "α = 1": [cell for cell in cells if cell.endswith(("/alpha-1", "/alpha-none"))],
        }
        for (name, shown), panel in zip(groups.items(), axes[2 * number :], strict=False):
            ends = []
            for cell in shown:
                ensemble = results.ensemble(cell)
                group = max(1, len(ensemble.last_step) // WINDOWS)
                begins = np.arange(0, len(ensemble.last_step), group)
                if judged_by == "falls":
                    steps = np.diff(ensemble.last_step, prepend=0)
                    per = np.add.reduceat(steps, begins) / 1_000
                    values = np.add.reduceat(ensemble.falls, begins, axis=1) / per
                else:
                    sizes = np.diff(begins, append=len(ensemble.last_step))
                    values = 100 * np.add.reduceat(ensemble.upright_share, begins, axis=1) / sizes
                last = ensemble.last_step[np.append(begins[1:], len(ensemble.last_step)) - 1]
                values = values[~ensemble.diverged]
                if not len(values):
                    continue
                low, middle, high = np.quantile(values, (0.25, 0.5, 0.75), axis=0)
                shade = colour(cell)
                panel.plot(last, middle, color=shade, linewidth=1.4)
                panel.fill_between(last, low, high, color=shade, alpha=0.12, linewidth=0)
                words = (
                    CellId.parse(cell).label
                    if name == "best α"
                    else CellId.parse(cell).architecture
                )
                ends.append((float(middle[-1]), words, shade))
            panel.set_visible(bool(cells))
            panel.set_title(f"{task}, {name}")
            panel.set_ylabel("falls per 1,000 steps" if judged_by == "falls" else "upright [%]")
            if judged_by == "upright":
                panel.set(ylim=(-4, 104), yticks=(0, 25, 50, 75, 100))
            else:
                panel.set_ylim(bottom=0)
            if shown:
                panel.set_xlim(0, float(last[-1]))
            panels.steps_axis(panel)
            panels.label_ends(panel, ends)
    caption = (
        "Medians over the runs, with the band between the quartiles. Left: each architecture with the "
        "step size that succeeds most often (the first, if several do). Right: all of them with α = 1."
    )
    return panels.Drawing(figure, caption, [])
