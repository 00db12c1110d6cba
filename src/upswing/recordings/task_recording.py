"""The recording of a task: every run of every cell, in one scale."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from numpy.typing import NDArray

from upswing.analysis.colours import label
from upswing.analysis.colours import name_of as called
from upswing.recordings.identical import once, runs_of
from upswing.recordings.shades import Colour, shades
from upswing.runs.files.atomic import written
from upswing.runs.recording.frames import STEP, rounded
from upswing.runs.recording.layout import whole_run
from upswing.runs.results import Ensemble, Results
from upswing.study.ids import CellId
from upswing.study.task import Task

POINTS = 100
"""Largest number of points of a run's line."""

PASSES = 20
"""Time in which a whole run passes, when it is played [s]."""

THICK, MIDDLING, THIN = 3.0, 1.5, 0.6

Real = NDArray[np.float64]


def write_task(path: Path, results: Results, task: str) -> None:
    """Every run of a task as a line: the share upright, or the falls, in a hundred windows.

    Medians and quartiles over the seeds are thicker; a view for each cell, and one of all medians. Cells
    whose runs are the same bit for bit are shown once.
    """
    same = identical(
        results, [name for name, cell in results.cells.items() if cell.task.name == task]
    )
    of_task = results.task(next(iter(same)))
    lines = {cell: _in_points(results.ensemble(cell)) for cell in same}
    colours = shades(same)
    highest = 100.0 if of_task.judged_by != "falls" else _highest(lines.values())
    names = {cell: name_of(cell, others) for cell, others in same.items()}
    words = _words(task, of_task, results, same, int(next(iter(lines.values()))[0][0]))
    with written(path) as beside:
        recording = rr.RecordingStream(f"upswing-task-{task}", recording_id=f"task-{task}")
        recording.save(beside, default_blueprint=_layout(of_task, names, highest))
        rr.send_recording_name(f"all runs of {task}: {_measure(of_task)}", recording=recording)
        recording.log("about", rr.TextDocument(words, media_type="text/markdown"), static=True)
        for cell, (last_step, values) in lines.items():
            ensemble = results.ensemble(cell)
            finite = values[~ensemble.diverged]
            counted = finite if len(finite) else values
            middle = np.median(counted, axis=0)
            quartiles = np.quantile(counted, (0.25, 0.75), axis=0)
            place = _entity(cell)
            for entity, curves, labels, width in (
                (f"cells/{place}/runs", values, [f"seed {seed}" for seed in ensemble.seeds], THIN),
                (f"cells/{place}/quartiles", quartiles, ["25 %", "75 %"], MIDDLING),
                (f"cells/{place}/median", middle[None], ["median"], THICK),
                (f"medians/{place}", middle[None], [names[cell]], MIDDLING),
            ):
                _send(recording, entity, last_step, curves, labels, width, colours[cell])
        recording.flush()
        recording.disconnect()


def identical(results: Results, cells: Sequence[str]) -> dict[str, list[str]]:
    """Each cell that is shown, and the others all of whose runs it has as well, bit for bit."""
    return once({cell: runs_of(results.cell(cell)) for cell in cells})


def name_of(cell: str, others: Sequence[str]) -> str:
    """What a cell is called, with those that have the same runs: ``table = modular-table, α = 1``."""
    one, same = CellId.parse(cell), [CellId.parse(other) for other in others]
    if all(other.alpha == one.alpha for other in same):
        together = " = ".join(called(each.architecture) for each in (one, *same))
        return one._replace(architecture=together).label
    return " = ".join(label(each) for each in (cell, *others))


def _measure(task: Task) -> str:
    return "falls" if task.judged_by == "falls" else "upright [%]"


def _layout(task: Task, names: Mapping[str, str], highest: float) -> rrb.Blueprint:
    scale = rrb.ScalarAxis(range=(-0.02 * highest, 1.05 * highest), zoom_lock=True)
    left = rrb.Vertical(
        rrb.TextDocumentView(name="What this is", origin="/about"),
        rrb.TimeSeriesView(
            name=f"Medians: {_measure(task)}",
            origin="/medians",
            axis_x=whole_run(),
            axis_y=scale,
            plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.LeftTop),
        ),
        row_shares=[2, 3],
    )
    views = [
        rrb.TimeSeriesView(
            name=name,
            origin=f"/cells/{_entity(cell)}",
            axis_x=whole_run(),
            axis_y=scale,
            plot_legend=rrb.PlotLegend(visible=False),
        )
        for cell, name in names.items()
    ]
    return rrb.Blueprint(
        rrb.Horizontal(left, rrb.Grid(*views, grid_columns=3), column_shares=[2, 3]),
        rrb.TimePanel(
            timeline=STEP, state="collapsed", playback_speed=1.0, fps=task.steps / PASSES
        ),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
    )


def _words(
    name: str, task: Task, results: Results, same: Mapping[str, Sequence[str]], window: int
) -> str:
    """What the recording of a task shows, in Markdown."""
    runs = sum(len(results.cell(cell)) for cell in same)
    what = (
        "the number of falls"
        if task.judged_by == "falls"
        else "the share of steps within 20° of upright"
    )
    twice = [
        f"{label(other)} (in {label(cell)})" for cell, others in same.items() for other in others
    ]
    lines = [
        f"### All runs of {name}",
        f"{runs:,} runs of {len(same)} cells, {task.steps:,} steps each. A line is a run: {what} in "
        f"every {window:,} steps. Of each cell the thickest line is the median over the runs; those "
        "beside it hold half of the runs.",
        "**One scale for all views.** A colour is an architecture; of its step sizes α the largest is "
        "darkest. A line ends where the run diverged; medians are of the other runs.",
        f"The timeline `step` is played {task.steps / PASSES:,.0f} steps a second, so that a run passes "
        f"in {PASSES} s; the speed stands at the bottom. Each run alone has a recording that plays in "
        "real time.",
    ]
    if twice:
        lines.append(
            "**Said once**, for every run of theirs is one of another cell, bit for bit: "
            + "; ".join(twice)
            + "."
        )
    return "\n\n".join(lines) + "\n"


def _highest(lines: Iterable[tuple[Real, Real]]) -> float:
    """The highest value of all lines; 1 if there is none above."""
    return max(1.0, *(float(np.nanmax(values, initial=0.0)) for _, values in lines))


def _in_points(ensemble: Ensemble) -> tuple[Real, Real]:
    """The windows of an ensemble in at most ``POINTS`` groups: last steps, and values (runs, groups)."""
    windows = len(ensemble.last_step)
    group = -(-windows // POINTS)
    begins = np.arange(0, windows, group)
    if ensemble.task.judged_by == "falls":
        values = np.add.reduceat(ensemble.falls, begins, axis=1)
    else:
        sizes = np.diff(begins, append=windows)
        values = 100 * np.add.reduceat(ensemble.upright_share, begins, axis=1) / sizes
    ends = np.minimum(begins + group, windows) - 1
    return ensemble.last_step[ends], values


def _send(
    recording: rr.RecordingStream,
    entity: str,
    steps: Real,
    values: Real,
    names: Sequence[str],
    width: float,
    colour: Colour,
) -> None:
    """Lines of (lines, points) ``values`` as one entity."""
    count = len(names)
    # Thin lines let the thick ones through.
    colours = [(*colour, 110 if width == THIN else 255)] * count
    lines = rr.SeriesLines(names=list(names), widths=[width] * count, colors=colours)
    recording.log(entity, lines, static=True)
    recording.send_columns(
        entity,
        indexes=[rr.TimeColumn(STEP, sequence=steps.astype(np.int64))],
        columns=rr.Scalars.columns(scalars=rounded(values.T).ravel()).partition(
            [len(names)] * len(steps)
        ),
    )


def _entity(cell: str) -> str:
    """A cell's place in the recording of its task."""
    _, architecture, alpha = CellId.parse(cell)
    return f"{architecture}/alpha-{alpha}"
