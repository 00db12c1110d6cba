"""Recordings that compare runs: all of a task, and the worst, median and best run of a claim."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import rerun as rr
import rerun.blueprint as rrb
from numpy.typing import NDArray

from upswing.analysis.colours import rgb
from upswing.physics.pendulum import Pendulum
from upswing.recordings.comparison_names import comparison_names
from upswing.runs.files.atomic import written
from upswing.runs.files.ledger import seal
from upswing.runs.recording.frames import DRAWN_EVERY, FRAME, STEP, rounded
from upswing.runs.recording.layout import PENDULUM_SIZE, whole_run
from upswing.runs.results import Ensemble, Results
from upswing.runs.simulation import body_of
from upswing.study.claims import Claim
from upswing.study.errors import BadInput, near
from upswing.study.ids import CellId, seed_of
from upswing.study.paths import RECORDINGS, comparison

POINTS = 100
"""Largest number of points of a run's line."""

SHOWN = 2_500
"""Length of the beginning and of the end that are shown of a claim's runs [steps]."""

RANKS = ("worst", "median", "best")
THICK, MIDDLING, THIN = 3.0, 1.5, 0.6


def write_comparisons(results: Results, claims: Mapping[str, Claim]) -> list[Path]:
    """Write all recordings that compare runs; returns their paths."""
    names = comparison_names(claims, results.cells)
    return [write_comparison(results, claims, name) for name in names]


def write_comparison(results: Results, claims: Mapping[str, Claim], name: str) -> Path:
    """Write one of them, ``task-…`` or ``claim-…``; returns its path.

    Raises:
        BadInput: there is no such comparison.
    """
    if name not in (known := comparison_names(claims, results.cells)):
        raise BadInput([f"comparison: {name}: no such comparison; {near(name, known)}"])
    rr.set_strict_mode(True)
    path = results.folder / comparison(name)
    what, _, of = name.partition("-")
    if what == "task":
        write_task(path, results, of)
    else:
        write_claim(path, results, of, str(claims[of].cell))
    seal(results.folder, f"{RECORDINGS}/{name}", [path])
    return path


def write_task(path: Path, results: Results, task: str) -> None:
    """Every run of a task as a line: the share upright, or the falls, in a hundred windows.

    Medians and quartiles over the seeds are thicker; a view for each cell, and one of all medians.
    """
    cells = [name for name, cell in results.cells.items() if cell.task.name == task]
    measure = "falls" if results.task(cells[0]).judged_by == "falls" else "upright [%]"
    views = [
        rrb.TimeSeriesView(
            name=f"Medians: {measure}",
            origin="/medians",
            axis_x=whole_run(),
            plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.LeftTop),
        ),
        *(
            rrb.TimeSeriesView(
                name=CellId.parse(cell).label,
                origin=f"/cells/{_entity(cell)}",
                axis_x=whole_run(),
                plot_legend=rrb.PlotLegend(visible=False),
            )
            for cell in cells
        ),
    ]
    layout = rrb.Blueprint(
        rrb.Horizontal(views[0], rrb.Grid(*views[1:], grid_columns=3), column_shares=[2, 3]),
        rrb.TimePanel(timeline=STEP, state="collapsed"),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
    )
    with written(path) as beside:
        recording = rr.RecordingStream(f"upswing-task-{task}", recording_id=f"task-{task}")
        recording.save(beside, default_blueprint=layout)
        rr.send_recording_name(f"all runs of {task}: {measure}", recording=recording)
        for cell in cells:
            ensemble = results.ensemble(cell)
            last_step, values = _in_points(ensemble)
            finite = values[~ensemble.diverged]
            counted = finite if len(finite) else values
            middle = np.median(counted, axis=0)
            quartiles = np.quantile(counted, (0.25, 0.75), axis=0)
            place, name, shade = _entity(cell), CellId.parse(cell).label, rgb(cell)
            for entity, lines, labels, width in (
                (f"cells/{place}/runs", values, [f"seed {seed}" for seed in ensemble.seeds], THIN),
                (f"cells/{place}/quartiles", quartiles, ["25 %", "75 %"], MIDDLING),
                (f"cells/{place}/median", middle[None], ["median"], THICK),
                (f"medians/{place}", middle[None], [name], MIDDLING),
            ):
                _send(recording, entity, last_step, lines, labels, width, shade)
        recording.flush()
        recording.disconnect()


def write_claim(path: Path, results: Results, claim: str, cell: str) -> None:
    """The worst, the median and the best run of a claim's cell: how they began and ended."""
    runs = [str(run) for run in results.three_of(cell)["run"]]
    body = body_of(results.cells[cell].task.pendulum)
    limit = 1.1 * results.task(cell).angle_limit
    columns = [
        rrb.Vertical(
            rrb.Spatial2DView(
                name=f"{rank}: seed {seed_of(run)}",
                origin=f"/{rank}/pendulum",
                visual_bounds=rrb.VisualBounds2D(
                    x_range=(-PENDULUM_SIZE, PENDULUM_SIZE), y_range=(-PENDULUM_SIZE, PENDULUM_SIZE)
                ),
            ),
            rrb.TimeSeriesView(
                name="Angle [°]",
                origin=f"/{rank}/angle",
                axis_y=rrb.ScalarAxis(range=(-limit, limit)),
                axis_x=whole_run(),
            ),
        )
        for rank, run in zip(RANKS, runs, strict=True)
    ]
    layout = rrb.Blueprint(
        rrb.Horizontal(*columns),
        rrb.TimePanel(timeline=FRAME, state="collapsed", fps=100.0),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
    )
    with written(path) as beside:
        recording = rr.RecordingStream(f"upswing-claim-{claim}", recording_id=f"claim-{claim}")
        recording.save(beside, default_blueprint=layout)
        rr.send_recording_name(
            f"{claim}: worst, median and best run of {cell}", recording=recording
        )
        for rank, run in zip(RANKS, runs, strict=True):
            _claimed_run(recording, rank, results.trajectory(run), body, rgb(cell))
        recording.flush()
        recording.disconnect()


def _claimed_run(
    recording: rr.RecordingStream,
    rank: str,
    trajectory: pd.DataFrame,
    body: Pendulum,
    shade: tuple[int, int, int],
) -> None:
    last = int(trajectory["step"].iloc[-1])
    shown = trajectory[(trajectory["step"] < SHOWN) | (trajectory["step"] > last - SHOWN)]
    steps, angle = shown["step"].to_numpy(), shown["angle"].to_numpy(float)
    degrees = np.degrees(angle)
    breaks = (np.diff(steps, prepend=steps[0]) > 1) | (
        np.abs(np.diff(degrees, prepend=degrees[0])) > 60
    )
    degrees[breaks] = np.nan
    frames = np.arange(len(steps))
    recording.log(f"{rank}/angle", rr.SeriesLines(names=["φ"], colors=[shade]), static=True)
    recording.send_columns(
        f"{rank}/angle",
        indexes=[rr.TimeColumn(FRAME, sequence=frames), rr.TimeColumn(STEP, sequence=steps)],
        columns=rr.Scalars.columns(scalars=rounded(degrees)),
    )
    tip = -body.orientation * body.length * np.stack([np.sin(angle), np.cos(angle)], axis=1)
    rods = np.stack([np.zeros_like(tip), tip], axis=1).astype(np.float32)[::DRAWN_EVERY]
    recording.log(
        f"{rank}/pendulum/rod",
        rr.LineStrips2D.from_fields(colors=[shade], radii=[0.006]),
        static=True,
    )
    recording.log(
        f"{rank}/pendulum/cart",
        rr.Boxes2D(half_sizes=[[0.05, 0.015]], centers=[[0, 0]], colors=[[90, 90, 90]]),
        static=True,
    )
    recording.send_columns(
        f"{rank}/pendulum/rod",
        indexes=[
            rr.TimeColumn(FRAME, sequence=frames[::DRAWN_EVERY]),
            rr.TimeColumn(STEP, sequence=steps[::DRAWN_EVERY]),
        ],
        columns=rr.LineStrips2D.columns(strips=list(rods)),
    )


def _in_points(ensemble: Ensemble) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
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
    steps: NDArray[np.float64],
    values: NDArray[np.float64],
    names: Sequence[str],
    width: float,
    colour: tuple[int, int, int],
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
