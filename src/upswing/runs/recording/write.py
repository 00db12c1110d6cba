"""The recording of one run: chosen stretches in full, envelopes between, and what was learned."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from upswing.physics.environment import Trajectory
from upswing.physics.pendulum import Pendulum
from upswing.runs.files.atomic import written
from upswing.runs.recording.frames import (
    SIM_TIME,
    STEP,
    TIMELINES,
    Frames,
    jumps,
    rounded,
    stretches,
    time_columns,
)
from upswing.runs.recording.happenings import Event, happenings, last_fall
from upswing.runs.recording.pictures import draw_learned, draw_pendulum, draw_phase_plane
from upswing.runs.recording.words import about
from upswing.runs.simulation import REWARD_SCALES
from upswing.runs.snapshots import Snapshots
from upswing.study.ids import recording_id, seed_of
from upswing.study.measured import Measures, Windows
from upswing.study.spec import parse

ENVELOPE = 200
"""Largest number of windows by whose lowest and highest angle the whole run is shown."""

DIGITS = 5
"""Of a property; what is exact stands in the table of runs."""

NOT_SHOWN = "not shown"
"""What the lane of stretches says between them."""


def write_recording(
    path: Path,
    run: str,
    trajectory: Trajectory,
    windows: Windows,
    measures: Measures,
    learned: Snapshots,
    body: Pendulum,
    properties: Mapping[str, Any],
) -> None:
    """Write the recording of ``run``, with its parameters and measures as ``properties``.

    The layout is not in it: it is registered with the catalog once. ``properties`` have the run's
    specification under ``spec``.

    Raises:
        OSError: it cannot be written; the disk may be full.
    """
    rr.set_strict_mode(True)  # otherwise errors become warnings and data is dropped
    recording = rr.RecordingStream(f"upswing-{run.split('/')[0]}", recording_id=recording_id(run))
    # Rerun's own writing of files ends at a full disk without saying so.
    memory = recording.memory_recording()
    try:
        rr.send_recording_name(run, recording=recording)
        recording.send_property("run", rr.AnyValues(**_known(properties)))
        frames = stretches(trajectory, windows, measures.first_stable_step, body.time_step)
        spec = parse(properties["spec"])
        fell = last_fall(trajectory, windows)
        words = about(spec, seed_of(run), measures, fell, frames, properties)
        recording.log("about", rr.TextDocument(words, media_type="text/markdown"), static=True)
        draw_lines(recording, frames, trajectory, body)
        draw_stretches(recording, frames)
        draw_envelope(recording, windows, frames)
        draw_pendulum(recording, frames, trajectory, body, spec.task.track.limit)
        draw_phase_plane(recording, frames, trajectory, learned)
        unit = REWARD_SCALES[spec.readings.reward_unit]
        draw_learned(recording, frames, learned, body, unit)
        _events(recording, frames, happenings(trajectory, windows, measures, frames))
        content = memory.drain_as_bytes()
    finally:
        recording.disconnect()
    with written(path) as beside:
        beside.write_bytes(content)


def draw_lines(
    recording: rr.RecordingStream, frames: Frames, trajectory: Trajectory, body: Pendulum
) -> None:
    """Angle, velocity, cart, action, reward and TD error of every step of the stretches."""
    at = np.minimum(frames.steps, len(trajectory.angle) - 1)
    accelerations = np.array(body.accelerations)[trajectory.action[at]]
    angle = np.degrees(trajectory.angle[at])
    lines: dict[str, dict[str, NDArray[Any]]] = {
        "angle": {"φ": np.where(jumps(angle, frames.time_step), np.nan, angle)},
        "angular_velocity": {"φ̇": trajectory.angular_velocity[at]},
        "cart/position": {"x": trajectory.cart_position[at]},
        "cart/velocity": {"ẋ": trajectory.cart_velocity[at]},
        "action": {"ẍ": accelerations},
        "learning": {"reward": trajectory.reward[at], "TD error": trajectory.td_error[at]},
    }
    for entity, columns in lines.items():
        # Where a pixel holds several steps, their extremes: a mean of actions is no action.
        style = rr.SeriesLines(
            names=list(columns), aggregation_policy=rr.components.AggregationPolicy.MinMax
        )
        recording.log(entity, style, static=True)
        values = rounded(np.stack(list(columns.values()), axis=1))
        values[frames.gap] = np.nan
        recording.send_columns(
            entity,
            indexes=time_columns(frames.steps, frames),
            columns=rr.Scalars.columns(scalars=values.ravel()).partition(
                [values.shape[1]] * len(values)
            ),
        )


def draw_envelope(recording: rr.RecordingStream, windows: Windows, frames: Frames) -> None:
    """The lowest and the highest angle over the whole run."""
    group = -(-len(windows.first_step) // ENVELOPE)
    begins = np.arange(0, len(windows.first_step), group)
    lowest = np.degrees(np.minimum.reduceat(windows.lowest_angle, begins))
    highest = np.degrees(np.maximum.reduceat(windows.highest_angle, begins))
    entity = "envelope/angle"
    recording.log(
        entity,
        rr.SeriesLines(names=["lowest", "highest"], colors=[[170, 170, 170]] * 2, widths=[0.8] * 2),
        static=True,
    )
    steps = windows.first_step[begins]
    recording.send_columns(
        entity,
        indexes=time_columns(steps, frames, (STEP, SIM_TIME)),
        columns=rr.Scalars.columns(
            scalars=rounded(np.stack([lowest, highest], axis=1)).ravel()
        ).partition([2] * len(steps)),
    )


def draw_stretches(recording: rr.RecordingStream, frames: Frames) -> None:
    """Which stretch it is at every moment, as a lane of colours; nothing in the gaps between."""
    states: dict[int, str] = {}
    for stretch in frames.named:
        states[stretch.first] = stretch.name
        states.setdefault(stretch.after, NOT_SHOWN)
    steps = np.array(sorted(states), dtype=np.int64)
    recording.send_columns(
        "stretch",
        indexes=time_columns(steps, frames),
        columns=rr.StateChange.columns(state=[states[step] for step in steps.tolist()]),
    )


def _events(recording: rr.RecordingStream, frames: Frames, events: list[Event]) -> None:
    """What happened, as lines of a log."""
    shown = set(frames.steps[~frames.gap].tolist())
    # What happened outside the stretches has no frame.
    for inside, timelines in ((True, TIMELINES), (False, (STEP, SIM_TIME))):
        if some := [event for event in events if (event.step in shown) == inside]:
            recording.send_columns(
                "events",
                indexes=time_columns(np.array([event.step for event in some]), frames, timelines),
                columns=rr.TextLog.columns(
                    text=[f"{event.text} · step {event.step:,}" for event in some],
                    level=[event.level for event in some],
                ),
            )


def _known(properties: Mapping[str, Any]) -> dict[str, Any]:
    """Without what is unknown, for a recording has no empty property; numbers as a table shows them."""
    return {
        name: float(f"{value:.{DIGITS}g}") if isinstance(value, float) else value
        for name, value in properties.items()
        if value is not None
    }
