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
    END,
    FRAME,
    STEP,
    drawn_every,
    jumps,
    real_time,
    rounded,
)
from upswing.runs.recording.labels import label
from upswing.runs.recording.layout import whole_run
from upswing.runs.recording.sizes import HALF_A_CART, unit_of, view_of
from upswing.runs.results import Results
from upswing.runs.simulation import body_of_run
from upswing.study.claim_parts import weakest, words_of
from upswing.study.claims import Claim
from upswing.study.ids import seed_of
from upswing.study.task import Task

SHOWN = 2_500
"""Length of the beginning and of the end that are shown of a claim's runs [steps of 5 ms].

Where steps are shorter, as many of them: more are not stored.
"""

RANKS = ("worst", "median", "best")


def write_claim(path: Path, results: Results, name: str, claim: Claim) -> None:
    """The worst, the median and the best run of a claim's cell: how they began and ended.

    The claim is judged anew, by its own cells, so that its recording depends on nothing else.
    """
    cell = str(claim.cell)
    three = results.three_of(cell)
    runs = [str(run) for run in three["run"]]
    body, colour = body_of_run(results.cells[cell]), visible(rgb(cell))
    length = _length(results.task(cell))
    trajectories = [_shown(results.trajectory(run), length) for run in runs]
    with written(path) as beside:
        recording = rr.RecordingStream(f"upswing-claim-{name}", recording_id=f"claim-{name}")
        recording.save(beside, default_blueprint=_layout(runs, results.task(cell)))
        rr.send_recording_name(f"{name}: worst, median and best run of {cell}", recording=recording)
        words = _words(results, name, claim, three)
        recording.log("about", rr.TextDocument(words, media_type="text/markdown"), static=True)
        _stretches(recording, trajectories[0]["step"].to_numpy())
        for rank, trajectory in zip(RANKS, trajectories, strict=True):
            _claimed_run(recording, rank, trajectory, body, colour)
        recording.flush()
        recording.disconnect()


def _layout(runs: Sequence[str], task: Task) -> rrb.Blueprint:
    angle_limit, (_, up) = task.angle_limit, view_of(task.pendulum.length)
    columns = [
        rrb.Vertical(
            rrb.Spatial2DView(
                name=f"{rank}: seed {seed_of(run)}",
                origin=f"/{rank}/pendulum",
                visual_bounds=rrb.VisualBounds2D(x_range=(-up, up), y_range=(-up, up)),
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
        rrb.TimePanel(
            timeline=FRAME,
            state="collapsed",
            playback_speed=1.0,
            fps=real_time(task.pendulum.time_step),
        ),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
    )


def _words(results: Results, name: str, claim: Claim, three: pd.DataFrame) -> str:
    """The claim, its verdict, and why these are its runs, in Markdown."""
    evidence = judge(results, name, claim)

    def said(verdict: str) -> str:
        return words_of(verdict, could_be_better=False, own=bool(results.study.claims))

    verdict = weakest([row.verdict for row in evidence])
    task, cell = results.task(str(claim.cell)), str(claim.cell)
    order = [measure for measure in task.order_of_runs if measure != "seed"]
    counted, all_runs = len(results.counted(cell)), len(results.cell(cell))
    left_out = "" if counted == all_runs else f" ({all_runs - counted} diverged and are left out)"
    if not counted:
        counted, left_out = all_runs, " (every one diverged)"
    by = ", then by ".join(
        f"{label(measure, task)} ({'lowest' if task.order_of_runs[measure] else 'highest'} first)"
        for measure in order
    )
    headings = " | ".join(label(measure, task) for measure in order)
    rows = [
        f"| {rank} | {row['seed']} | "
        + " | ".join(f"{row[measure]:,.4g}" for measure in order)
        + " |"
        for rank, (_, row) in zip(RANKS, three.iterrows(), strict=True)
    ]
    speed = f"{real_time(task.pendulum.time_step):g} frames a second"
    check = f"\n\nIt is a check and no evidence: {claim.check}." if claim.check else ""
    note = f"\n\n{claim.note}" if claim.note else ""
    return f"""\
### {name}{f" ({claim.section})" if claim.section else ""}

{claim.statement}

**Verdict: {said(verdict)}.** {"It is that of its weakest part." if len(evidence) > 1 else ""}

{chr(10).join(_line(row, said(row.verdict)) for row in evidence)}{check}{note}

**Why these runs**: the worst, the median and the best of {counted:,} runs of `{cell}`{left_out}, ordered
by {by}.

| | seed | {headings} |
| --- | --- | {" | ".join("---" for _ in order)} |
{chr(10).join(rows)}

The timeline `frame` plays the first and the last {_length(task):,} steps of the three side by side, at
**{speed}: as fast as it happened**. The speed stands at the bottom and can be
changed there.
"""


def _line(row: Evidence, verdict: str) -> str:
    """A part of a claim: what is measured, how it came out, and what that comes to."""
    words = f"- {row.says}: "
    if row.estimate == row.estimate:
        words += f"**{row.estimate:.3g}**, 95 % interval {row.low:.3g} to {row.high:.3g}; "
    cells = f" ({row.cells.replace(' : ', ' and ')})" if row.cells else ""
    return f"{words}asked for {row.threshold}: **{verdict}**{cells}"


def _length(task: Task) -> int:
    """Length of the beginning and of the end that are shown [steps]."""
    return min(SHOWN, task.steps_of(SHOWN))


def _shown(trajectory: pd.DataFrame, length: int) -> pd.DataFrame:
    """The rows of a run that are shown: so many steps of its beginning and of its end."""
    last = int(trajectory["step"].iloc[-1])
    return trajectory[(trajectory["step"] < length) | (trajectory["step"] > last - length)]


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
    new = np.diff(steps, prepend=steps[0]) > 1
    degrees[new | jumps(degrees, body.time_step)] = np.nan
    frames, every, unit = np.arange(len(steps)), drawn_every(body.time_step), unit_of(body.length)
    recording.log(f"{rank}/angle", rr.SeriesLines(names=["φ"], colors=[colour]), static=True)
    recording.send_columns(
        f"{rank}/angle",
        indexes=[rr.TimeColumn(FRAME, sequence=frames), rr.TimeColumn(STEP, sequence=steps)],
        columns=rr.Scalars.columns(scalars=rounded(degrees)),
    )
    tip = -body.orientation * body.length * np.stack([np.sin(angle), np.cos(angle)], axis=1)
    rods = np.stack([np.zeros_like(tip), tip], axis=1).astype(np.float32)[::every]
    recording.log(
        f"{rank}/pendulum/rod",
        rr.LineStrips2D.from_fields(colors=[colour], radii=[0.006 * unit]),
        static=True,
    )
    recording.log(
        f"{rank}/pendulum/cart",
        rr.Boxes2D(
            half_sizes=[[HALF_A_CART * unit, 0.015 * unit]], centers=[[0, 0]], colors=[[90, 90, 90]]
        ),
        static=True,
    )
    recording.send_columns(
        f"{rank}/pendulum/rod",
        indexes=[
            rr.TimeColumn(FRAME, sequence=frames[::every]),
            rr.TimeColumn(STEP, sequence=steps[::every]),
        ],
        columns=rr.LineStrips2D.columns(strips=list(rods)),
    )
