"""Learning curves: how often the pendulum falls, or is upright, as training goes on."""

from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results
    from upswing.study.task import NamedTask

FIGURE = Declaration("Learning curves", "", ("C1", "C4", "C5", "C10", "C12"))
WINDOWS = 40
"""Number of points of a curve."""


def draw(results: "Results") -> "Drawing":
    """Panels for the first task of each way of judging: medians of cells, with their quartiles."""
    import numpy as np

    from upswing.analysis.colours import colour, label, name_of
    from upswing.figures import panels
    from upswing.figures.interaction import Curves, remember
    from upswing.figures.style import dashes, grid_of_panels
    from upswing.study.ids import CellId

    figure, axes = grid_of_panels(2, (1, 1), height=2.4)
    seen: list[str] = []
    with_one = others = False
    for number, judged_by in enumerate(("falls", "upright")):
        tasks = [
            spec.task.name for spec in results.cells.values() if spec.task.judged_by == judged_by
        ]
        task = tasks[0] if tasks else ""
        others |= len({task.pendulum for task in _tasks(results, judged_by)}) > 1
        cells = [cell for cell, spec in results.cells.items() if spec.task.name == task]
        # Of each architecture the step size with most successes, and with α = 1 if that is another.
        chosen: dict[str, str] = {}
        for cell in cells:
            architecture = CellId.parse(cell).architecture
            best = chosen.get(architecture)
            if best is None or _succeeds(results, cell) > _succeeds(results, best):
                chosen[architecture] = cell
        groups = {
            "best α": list(chosen.values()),
            "α = 1": [cell for cell in cells if cell.endswith(("/alpha-1", "/alpha-none"))],
        }
        for (name, shown), panel in zip(groups.items(), axes[2 * number :], strict=False):
            ends = []
            learned = []  # where the medians of those that learn come to
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
                remember(panel, Curves(cell, ensemble.seeds, last, values, drawn=False))
                values = values[~ensemble.diverged]
                if not len(values):
                    continue
                low, middle, high = np.quantile(values, (0.25, 0.5, 0.75), axis=0)
                shade = colour(cell)
                panel.plot(last, middle, dashes(cell), color=shade, linewidth=1.4)
                panel.fill_between(last, low, high, color=shade, alpha=0.12, linewidth=0)
                words = (
                    label(cell) if name == "best α" else name_of(CellId.parse(cell).architecture)
                )
                ends.append((float(middle[-1]), words, shade))
                if results.cells[cell].alpha is not None:
                    learned.append((float(middle[-1]), words))
            if name == "best α" and learned:
                seen.append(f"{task}: {_ends(learned, judged_by)}")
            panel.set_visible(bool(shown))
            with_one |= name == "α = 1" and bool(shown)
            panel.set_title(f"{task}, {name}")
            panel.set_ylabel("falls per 1,000 steps" if judged_by == "falls" else "upright [%]")
            if judged_by == "upright":
                panel.set(ylim=(-4, 104), yticks=(0, 25, 50, 75, 100))
            else:
                panel.set_ylim(bottom=0)
            if shown:
                panel.set_xlim(0, float(last[-1]))
            panels.steps_axis(panel, [results.task(cell) for cell in shown], 4)
            panels.label_ends(panel, ends)
    what = ". ".join(seen)
    where = " on the left" if with_one else ""
    see = f" What to see: where the medians{where} end. {what}." if what else ""
    right = " Right: all of them with α = 1." if with_one else ""
    first = " Of several tasks of a kind, only the first is shown." if others else ""
    caption = (
        "Medians over the runs, with the band between the quartiles; modular ones are dashed. "
        f"{'Left: each' if with_one else 'Each'} architecture with the step size that succeeds most "
        "often (the first, if several do)."
        f"{right}{first}{see}"
    )
    alt = f"Where the medians end with the best α. {what}." if what else ""
    return panels.Drawing(figure, caption, [], alt)


def _tasks(results: "Results", judged_by: str) -> "list[NamedTask]":
    """The tasks that are judged in this way."""
    every = {spec.task.name: spec.task for spec in results.cells.values()}
    return [task for task in every.values() if task.judged_by == judged_by]


def _succeeds(results: "Results", cell: str) -> float:
    """The share of a cell's runs that succeed [%]; below all others where every run diverged."""
    from upswing.figures.success_share import share

    found = share(results, cell)
    return found.value if found.of else -1.0


def _ends(learned: list[tuple[float, str]], judged_by: str) -> str:
    """Where medians come to, the best first, as a sentence."""
    from upswing.figures import told

    falls = judged_by == "falls"
    ordered = sorted(learned, key=lambda one: one[0] if falls else -one[0])
    values = [
        f"{words} at {told.number(round(value, 1))}{'' if falls else ' %'}"
        for value, words in ordered
    ]
    return f"{'; '.join(values)} {'falls per 1,000 steps' if falls else 'of steps upright'}"
