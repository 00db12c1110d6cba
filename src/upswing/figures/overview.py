"""All cells at a glance: every run, and how many succeed."""

from typing import TYPE_CHECKING

from upswing.figures.declaration import Declaration

if TYPE_CHECKING:
    from collections.abc import Sequence

    from upswing.figures.panels import Drawing
    from upswing.runs.results import Results

FIGURE = Declaration("All cells at a glance", "", ("C3", "C6", "C8", "C9", "C10", "C12", "C13"))
HALF = 50.0
"""More per cent than this are most."""

ROW = 0.19
"""Height of a cell [inch]."""


def draw(results: "Results") -> "Drawing":
    """A row for each cell: a dot a run, and the share of runs that succeed with its interval."""
    import numpy as np

    from upswing.analysis.colours import colour, label, of_text
    from upswing.figures import panels
    from upswing.figures.captions import succeeding
    from upswing.figures.interaction import Dots, remember
    from upswing.figures.lengths import end_of
    from upswing.figures.style import WIDTH, subplots
    from upswing.figures.success_share import share
    from upswing.runs.success import SUCCESS
    from upswing.study.ids import CellId

    tasks: dict[str, list[str]] = {}
    for cell in results.cells:
        tasks.setdefault(CellId.parse(cell).task, []).append(cell)
    heights = [len(cells) + 2.5 for cells in tasks.values()]
    figure, grid = subplots(
        len(tasks), 2, figsize=(WIDTH, ROW * sum(heights) + 0.4), height_ratios=heights,
        width_ratios=(1, 1), sharey="row", squeeze=False,
    )  # fmt: skip
    seen = []
    for (task, cells), (left, right) in zip(tasks.items(), grid, strict=True):
        seen.append(_best(results, task, [c for c in cells if results.cells[c].alpha is not None]))
        by_falls = results.task(cells[0]).judged_by == "falls"
        for row, cell in enumerate(cells):
            runs, lost = results.counted(cell), int(results.cell(cell)["diverged_at"].notna().sum())
            shade = colour(cell)
            values = runs["falls_last_fifth"] if by_falls else 100 * runs["upright_at_end"]
            # Seeds lie a little apart, in their order.
            apart = np.linspace(-0.28, 0.28, len(values))
            left.scatter(
                values, row + apart, s=4, color=shade, alpha=0.6, linewidths=0, rasterized=True
            )
            remember(left, Dots(cell, list(runs["seed"]), values.to_numpy(float), row + apart))
            found = share(results, cell)
            right.hlines(row, found.low, found.high, color=shade, linewidth=2.5, alpha=0.45)
            right.plot(found.value, row, "o", color=shade, markersize=4)
            words = f"{found.successes} of {found.of}" + (f", {lost} diverged" if lost else "")
            right.annotate(
                words,
                (1.02, row),
                xycoords=("axes fraction", "data"),
                va="center",
                color=of_text(shade),
            )
        left.set_yticks(range(len(cells)), [label(cell) for cell in cells])
        left.set_ylim(len(cells) - 0.4, -0.6)
        left.set_title(f"{task}: every run")
        right.set(xlim=(-3, 103), xticks=(0, 25, 50, 75, 100))
        if by_falls:
            left.set_xscale("symlog", linthresh=1)
            left.set_xlim(-0.15, None)
            left.set_xticks((0, 1, 10, 100), ("0", "1", "10", "100"))
            left.set_xlabel("falls in the last fifth")
            right.set_title("Runs without a fall in the last fifth [%]")
        else:
            left.set(xlim=(-3, 103), xticks=(0, 25, 50, 75, 100))
            left.set_xlabel(f"upright in the last {end_of([results.task(cells[0])])} [%]")
            right.set_title(f"Runs upright for {100 * SUCCESS:.0f} % of them [%]")
        for axes in (left, right):
            axes.grid(visible=False, axis="y")
    what = "; ".join(seen)
    every = [spec.task for spec in results.cells.values()]
    stands = f"are upright for {100 * SUCCESS:.0f} % of their last {end_of(every)}"
    done = {
        "falls": "balance without a fall in their last fifth",
        "upright": f"stand at the end ({stands})",
    }
    caption = (
        "Each row is a cell. Left: every run as a dot, its seeds from top to bottom. Right: the share "
        f"of runs that {succeeding(every, done)}; the bar is its 95 % interval (Wilson). "
        f"What to see: {what}."
    )
    return panels.Drawing(figure, caption, [], f"{what[:1].upper()}{what[1:]}.")


def _best(results: "Results", task: str, cells: "Sequence[str]") -> str:
    """In how many cells of a task that learn most runs succeed, and which of them is the best."""
    from upswing.analysis.colours import label
    from upswing.figures.success_share import share

    if not cells:
        return f"in {task} none learns"
    found = {cell: share(results, cell) for cell in cells}
    best = max(found, key=lambda cell: found[cell].value if found[cell].of else -1.0)
    most = sum(one.value > HALF for one in found.values())
    words = f"{found[best].successes} of {found[best].of} with {label(best)}"
    return (
        f"in {task} most runs succeed in {most} of {len(cells)} cells that learn, at best {words}"
    )
