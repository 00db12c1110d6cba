"""The recording of a claim: its worst, median and best run side by side, and what they are shown for."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd
import rerun as rr
import rerun.blueprint as rrb

from upswing.analysis.colours import rgb
from upswing.analysis.verdicts import Evidence, judge
from upswing.physics.pendulum import Pendulum
from upswing.recordings.shades import Colour, visible
from upswing.runs.files.atomic import written
from upswing.runs.recording.frames import (
    BEGINNING,
    DRAWN_EVERY,
    END,
    FRAME,
    REAL_TIME,
    STEP,
    rounded,
)
from upswing.runs.recording.labels import label
from upswing.runs.recording.layout import PENDULUM_SIZE, whole_run
from upswing.runs.results import Results
from upswing.runs.simulation import body_of
from upswing.study.claim_parts import weakest
from upswing.study.claims import Claim
from upswing.study.ids import seed_of

SHOWN = 2_500
"""Length of the beginning and of the end that are shown of a claim's runs [steps]."""

RANKS = ("worst", "median", "best")


def write_claim(path: Path, results: Results, name: str, claim: Claim) -> None:
    """The worst, the median and the best run of a claim's cell: how they began and ended.

    The claim is judged anew, by its own cells, so that its recording depends on nothing else.
    """
    cell = str(claim.cell)
    three = results.three_of(cell)
    runs = [str(run) for run in three["run"]]
    body, colour = body_of(results.cells[cell]), visible(rgb(cell))
    trajectories = [_shown(results.trajectory(run)) for run in runs]
    with written(path) as beside:
        recording = rr.RecordingStream(f"upswing-claim-{name}", recording_id=f"claim-{name}")
        recording.save(beside, default_blueprint=_layout(runs, results.task(cell).angle_limit))
        rr.send_recording_name(f"{name}: worst, median and best run of {cell}", recording=recording)
        words = _words(results, name, claim, three)
        recording.log("about", rr.TextDocument(words, media_type="text/markdown"), static=True)
        _stretches(recording, trajectories[0]["step"].to_numpy())
        for rank, trajectory in zip(RANKS, trajectories, strict=True):
            _claimed_run(recording, rank, trajectory, body, colour)
        recording.flush()
        recording.disconnect()


def _layout(runs: Sequence[str], angle_limit: float) -> rrb.Blueprint:
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
                axis_y=rrb.ScalarAxis(range=(-1.1 * angle_limit, 1.1 * angle_limit)),
                axis_x=whole_run(),
            ),
        )
        for rank, run in zip(RANKS, runs, strict=True)
    ]
    words = rrb.Vertical(
        rrb.TextDocumentView(name="What this is", origin="/about"),
        rrb.StateTimelineView(
            name="Which stretch of the runs", origin="/stretch", time_view=whole_run()
        ),
        row_shares=[5, 1],
    )
    return rrb.Blueprint(
        rrb.Horizontal(words, *columns, column_shares=[4, 3, 3, 3]),
        rrb.TimePanel(timeline=FRAME, state="collapsed", playback_speed=1.0, fps=REAL_TIME),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
    )


def _words(results: Results, name: str, claim: Claim, three: pd.DataFrame) -> str:
    """The claim, its verdict, and why these are its runs, in Markdown."""
    evidence = judge(results, name, claim)
    verdict = weakest([row.verdict for row in evidence])
    task, cell = results.task(str(claim.cell)), str(claim.cell)
    order = [measure for measure in task.order_of_runs if measure != "seed"]
    counted, all_runs = len(results.in_order(cell)), len(results.cell(cell))
    left_out = "" if counted == all_runs else f" ({all_runs - counted} diverged and are left out)"
    by = ", then by ".join(
        f"{label(measure)} ({'lowest' if task.order_of_runs[measure] else 'highest'} first)"
        for measure in order
    )
    rows = [
        f"| {rank} | {row['seed']} | "
        + " | ".join(f"{row[measure]:,.4g}" for measure in order)
        + " |"
        for rank, (_, row) in zip(RANKS, three.iterrows(), strict=True)
    ]
    check = f"\n\nIt is a check and no evidence: {claim.check}." if claim.check else ""
    note = f"\n\n{claim.note}" if claim.note else ""
    return f"""\
### {name} ({claim.section})

{claim.statement}

**Verdict: {verdict}.** {"It is that of its weakest part." if len(evidence) > 1 else ""}

{chr(10).join(map(_line, evidence))}{check}{note}

**Why these runs**: the worst, the median and the best of {counted:,} runs of `{cell}`{left_out}, ordered
by {by}.

| | seed | {" | ".join(map(label, order))} |
| --- | --- | {" | ".join("---" for _ in order)} |
{chr(10).join(rows)}

The timeline `frame` plays the first and the last {SHOWN:,} steps of the three side by side, at
**{REAL_TIME:g} frames a second: as fast as it happened**. The speed stands at the bottom and can be
changed there.
"""


def _line(row: Evidence) -> str:
    """A part of a claim: what is measured, how it came out, and what that comes to."""
    words = f"- {row.says}: "
    if row.estimate == row.estimate:
        words += f"**{row.estimate:.3g}**, 95 % interval {row.low:.3g} to {row.high:.3g}; "
    cells = f" ({row.cells.replace(' : ', ' and ')})" if row.cells else ""
    return f"{words}asked for {row.threshold}: **{row.verdict}**{cells}"


def _shown(trajectory: pd.DataFrame) -> pd.DataFrame:
    """The rows of a run that are shown."""
    last = int(trajectory["step"].iloc[-1])
    return trajectory[(trajectory["step"] < SHOWN) | (trajectory["step"] > last - SHOWN)]


def _stretches(recording: rr.RecordingStream, steps: "np.ndarray") -> None:
    """Whether it is the beginning or the end of the runs, as a lane of colours."""
    begins = np.array([0, *(np.flatnonzero(np.diff(steps) > 1) + 1)])
    recording.send_columns(
        "stretch",
        indexes=[
            rr.TimeColumn(FRAME, sequence=begins),
            rr.TimeColumn(STEP, sequence=steps[begins]),
        ],
        columns=rr.StateChange.columns(state=[BEGINNING, END][: len(begins)]),
    )


def _claimed_run(
    recording: rr.RecordingStream, rank: str, shown: pd.DataFrame, body: Pendulum, colour: Colour
) -> None:
    steps, angle = shown["step"].to_numpy(), shown["angle"].to_numpy(float)
    degrees = np.degrees(angle)
    breaks = (np.diff(steps, prepend=steps[0]) > 1) | (
        np.abs(np.diff(degrees, prepend=degrees[0])) > 60
    )
    degrees[breaks] = np.nan
    frames = np.arange(len(steps))
    recording.log(f"{rank}/angle", rr.SeriesLines(names=["φ"], colors=[colour]), static=True)
    recording.send_columns(
        f"{rank}/angle",
        indexes=[rr.TimeColumn(FRAME, sequence=frames), rr.TimeColumn(STEP, sequence=steps)],
        columns=rr.Scalars.columns(scalars=rounded(degrees)),
    )
    tip = -body.orientation * body.length * np.stack([np.sin(angle), np.cos(angle)], axis=1)
    rods = np.stack([np.zeros_like(tip), tip], axis=1).astype(np.float32)[::DRAWN_EVERY]
    recording.log(
        f"{rank}/pendulum/rod",
        rr.LineStrips2D.from_fields(colors=[colour], radii=[0.006]),
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
