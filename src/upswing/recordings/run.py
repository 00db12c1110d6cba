"""The recording of one run: chosen stretches in full, envelopes between, and what was learned."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from upswing.loop import Trajectory
from upswing.measures import Measures, Windows
from upswing.pendulum import Pendulum
from upswing.recordings.layout import FRAME, SIM_TIME, STEP, TIMELINES, run_layout
from upswing.snapshots import Snapshots
from upswing.store.files import written
from upswing.tasks import ACCELERATIONS, ACTIONS
from upswing.tiles import VELOCITY_LIMIT

STRETCH = 450
"""Of the beginning, the first success, the worst stretch and the end, so much is shown [steps]."""

BEFORE_SUCCESS = 150
"""The stretch of the first success begins so much before it [steps]."""

DRAWN_EVERY = 4
"""The pendulum is drawn 50 times a second [steps]."""

TRAIL = 24
"""The phase plane shows the last so many drawings, half a second."""

ENVELOPE = 200
"""The whole run is shown by the lowest and the highest angle of so many windows, at most."""

LOGGED_FALLS = 50
PIXELS = (10, 4)
"""The size of a tile in the maps: of φ and of φ̇."""

ACTION_COLOURS = ((0, 114, 178), (221, 221, 221), (213, 94, 0))
MODULES = ("balancing", "upswing")
UNDECIDED = len(MODULES) * ACTIONS
"""The class of a tile where several actions are equally good, as where nothing is known yet."""

Real = NDArray[np.float64]
Steps = NDArray[np.int64]


class Frames(NamedTuple):
    """The rows of a recording: steps in stretches, each followed by one row of a gap."""

    steps: Steps  # (rows,)
    gap: NDArray[np.bool_]  # rows that only end a line: (rows,)

    def at(self, steps: Steps) -> Steps:
        """The first frame at or after each of ``steps``; the last frame if there is none."""
        return np.minimum(np.searchsorted(self.steps, steps), len(self.steps) - 1)


def write_recording(
    path: Path,
    run: str,
    kind: str,
    trajectory: Trajectory,
    windows: Windows,
    measures: Measures,
    learned: Snapshots,
    body: Pendulum,
    properties: Mapping[str, Any],
    with_layout: bool = False,
) -> None:
    """Write the recording of ``run``, with its parameters and measures as ``properties``.

    The layout is registered with the catalog once, and not in every file; ``with_layout`` embeds it,
    for a file that is handed out singly.
    """
    rr.set_strict_mode(True)  # otherwise errors become warnings and data is dropped
    with written(path) as beside:
        recording = rr.RecordingStream(
            f"upswing-{run.split('/')[0]}", recording_id=recording_id(run)
        )
        recording.save(beside, default_blueprint=run_layout(kind) if with_layout else None)
        rr.send_recording_name(run, recording=recording)
        recording.send_property("run", rr.AnyValues(**_known(properties)))
        frames = stretches(trajectory, windows, measures.first_stable_step)
        _about(recording, run, properties)
        _lines(recording, frames, trajectory)
        _envelope(recording, windows, frames)
        _pendulum(recording, frames, trajectory, body)
        _phase(recording, frames, trajectory, learned)
        _learned(recording, frames, learned)
        _events(recording, frames, trajectory, measures)
        recording.flush()
        recording.disconnect()


def recording_id(run: str) -> str:
    """The id of a run's recording; the viewer takes letters, digits, ``_`` and ``-`` only."""
    return run.replace("/", "_").replace(".", "-")


def stretches(trajectory: Trajectory, windows: Windows, first_stable_step: int | None) -> Frames:
    """The stretches shown in full: the beginning, the first success, the worst window, the end."""
    steps = len(trajectory.angle)
    worst = np.lexsort((windows.mean_reward, -windows.falls))[0]
    begins = [0, int(windows.first_step[worst]), steps - STRETCH]
    if first_stable_step is not None:
        begins.append(first_stable_step - BEFORE_SUCCESS)
    shown = np.zeros(steps + 1, dtype=np.bool_)
    for begin in begins:
        shown[max(0, begin) : max(0, begin) + STRETCH] = True
    shown[steps] = False
    ends = np.flatnonzero(shown[:-1] & ~shown[1:]) + 1
    rows = np.sort(np.concatenate([np.flatnonzero(shown), ends]))
    # A gap's row stands at the first step that is not shown.
    return Frames(rows, ~shown[rows])


def _lines(recording: rr.RecordingStream, frames: Frames, trajectory: Trajectory) -> None:
    """Angle, velocity, cart, action, reward and TD error of every step of the stretches."""
    at = np.minimum(frames.steps, len(trajectory.angle) - 1)
    accelerations = np.array(ACCELERATIONS)[trajectory.action[at]]
    angle = np.degrees(trajectory.angle[at])
    lines: dict[str, dict[str, NDArray[Any]]] = {
        "angle": {"φ": np.where(_jumps(angle), np.nan, angle)},
        "angular_velocity": {"φ̇": trajectory.angular_velocity[at]},
        "cart/position": {"x": trajectory.cart_position[at]},
        "cart/velocity": {"ẋ": trajectory.cart_velocity[at]},
        "action": {"ẍ": accelerations},
        "learning": {"reward": trajectory.reward[at], "TD error": trajectory.td_error[at]},
    }
    for entity, columns in lines.items():
        recording.log(entity, rr.SeriesLines(names=list(columns)), static=True)
        values = rounded(np.stack(list(columns.values()), axis=1))
        values[frames.gap] = np.nan
        recording.send_columns(
            entity,
            indexes=_times(frames.steps, frames),
            columns=rr.Scalars.columns(scalars=values.ravel()).partition(
                [values.shape[1]] * len(values)
            ),
        )


def _jumps(angle: Real) -> NDArray[np.bool_]:
    """Where an angle [°] has come round or was reset: no line leads there."""
    return np.abs(np.diff(angle, prepend=angle[:1])) > 60


def _envelope(recording: rr.RecordingStream, windows: Windows, frames: Frames) -> None:
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
        indexes=_times(steps, frames, (STEP, SIM_TIME)),
        columns=rr.Scalars.columns(
            scalars=rounded(np.stack([lowest, highest], axis=1)).ravel()
        ).partition([2] * len(steps)),
    )


def _pendulum(
    recording: rr.RecordingStream, frames: Frames, trajectory: Trajectory, body: Pendulum
) -> None:
    """The pendulum on its cart, seen from the cart; the ground passes below."""
    shown = frames.steps[~frames.gap][::DRAWN_EVERY]
    angle = trajectory.angle[shown].astype(np.float64)
    # The picture's y points down; with φ from upright a positive angle leans to the left.
    tip = -body.orientation * body.length * np.stack([np.sin(angle), np.cos(angle)], axis=1)
    rods = np.stack([np.zeros_like(tip), tip], axis=1).astype(np.float32)
    indexes = _times(shown, frames)
    recording.log(
        "pendulum/cart",
        rr.Boxes2D(half_sizes=[[0.05, 0.015]], centers=[[0, 0]], colors=[[90, 90, 90]]),
        static=True,
    )
    marks = np.arange(-8, 9) * 0.1
    recording.log(
        "pendulum/ground",
        rr.LineStrips2D([[[x, 0.03], [x, 0.04]] for x in marks], colors=[[120, 120, 120]]),
        static=True,
    )
    recording.log(
        "pendulum/rod",
        rr.LineStrips2D.from_fields(colors=[[0, 158, 115]], radii=[0.006]),
        static=True,
    )
    recording.send_columns(
        "pendulum/rod", indexes=indexes, columns=rr.LineStrips2D.columns(strips=list(rods))
    )
    ground = np.zeros((len(shown), 3), dtype=np.float32)
    ground[:, 0] = -(trajectory.cart_position[shown] % 0.1)
    recording.send_columns(
        "pendulum/ground", indexes=indexes, columns=rr.Transform3D.columns(translation=ground)
    )
    push = np.zeros((len(shown), 2), dtype=np.float32)
    push[:, 0] = np.array(ACCELERATIONS)[trajectory.action[shown]] / 100
    recording.log(
        "pendulum/push",
        rr.Arrows2D.from_fields(colors=[[213, 94, 0]], radii=[0.004], origins=[[0, 0.022]]),
        static=True,
    )
    recording.send_columns(
        "pendulum/push", indexes=indexes, columns=rr.Arrows2D.columns(vectors=push)
    )


def _phase(
    recording: rr.RecordingStream, frames: Frames, trajectory: Trajectory, learned: Snapshots
) -> None:
    """The state in the plane of φ and φ̇, over the map of the policy."""
    shown = frames.steps[~frames.gap][::DRAWN_EVERY]
    width, height = (parts * size for parts, size in zip(learned.owner.shape, PIXELS, strict=True))
    limit = learned.angle_limit
    x = (np.clip(trajectory.angle[shown], -limit, limit) + limit) / (2 * limit) * width
    velocity = np.clip(trajectory.angular_velocity[shown], -VELOCITY_LIMIT, VELOCITY_LIMIT)
    y = (VELOCITY_LIMIT - velocity) / (2 * VELOCITY_LIMIT) * height
    places = np.stack([x, y], axis=1).astype(np.float32)
    # A trail ends where the stretch began, the pendulum was reset, or φ came round.
    new = (np.diff(shown, prepend=shown[0]) > DRAWN_EVERY) | (
        np.abs(np.diff(places[:, 0], prepend=places[0, 0])) > width / 4
    )
    begins = np.maximum.accumulate(np.where(new, np.arange(len(shown)), 0))
    trails = [
        places[max(begin, end - TRAIL) : end + 1 : 3] if end > begin else places[[end, end]]
        for end, begin in enumerate(begins)
    ]
    recording.log(
        "phase/trail",
        rr.LineStrips2D.from_fields(colors=[[0, 0, 0, 160]], radii=[0.35], draw_order=10.0),
        static=True,
    )
    recording.log(
        "phase/state",
        rr.Points2D.from_fields(colors=[[0, 0, 0]], radii=[1.2], draw_order=11.0),
        static=True,
    )
    indexes = _times(shown, frames)
    recording.send_columns(
        "phase/trail", indexes=indexes, columns=rr.LineStrips2D.columns(strips=trails)
    )
    recording.send_columns(
        "phase/state", indexes=indexes, columns=rr.Points2D.columns(positions=places)
    )


def _learned(recording: rr.RecordingStream, frames: Frames, learned: Snapshots) -> None:
    """Value and greedy policy over the grid, as they grew."""
    names = [f"{ẍ:+.0f} m/s²" for ẍ in ACCELERATIONS]
    modules = int(learned.owner.max()) + 1
    classes = [
        rr.AnnotationInfo(
            id=module * ACTIONS + action,
            label=f"{MODULES[module]}: {names[action]}" if modules > 1 else names[action],
            color=tuple(int(c * (1 - 0.25 * module)) for c in ACTION_COLOURS[action]),
        )
        for module in range(modules)
        for action in range(ACTIONS)
    ]
    classes.append(rr.AnnotationInfo(id=UNDECIDED, label="undecided", color=(60, 60, 60)))
    recording.log("learned", rr.AnnotationContext(classes), static=True)
    recording.log("phase", rr.AnnotationContext(classes), static=True)
    finite = np.nan_to_num(learned.q, nan=0.0, posinf=0.0, neginf=np.finfo(np.float64).min)
    equals = (finite == finite.max(axis=-1, keepdims=True)).sum(axis=-1)
    policy = np.where(equals > 1, UNDECIDED, finite.argmax(axis=-1) + ACTIONS * learned.owner)
    value = finite.max(axis=-1)
    lowest = min(float(value.min()), -1e-9)
    shade = np.clip(np.round(255 * (1 - value / lowest)), 0, 255)
    steps = np.minimum(learned.steps, frames.steps[-1])
    for entity, maps, kind in (
        ("learned/policy", policy, rr.SegmentationImage),
        ("learned/value", shade, rr.DepthImage),
    ):
        images = np.stack([_picture(one) for one in maps])
        format_ = rr.components.ImageFormat(
            width=images.shape[2], height=images.shape[1], color_model="L", channel_datatype="U8"
        )
        recording.log(entity, kind.from_fields(format=format_), static=True)
        if kind is rr.DepthImage:
            recording.log(
                entity,
                rr.DepthImage.from_fields(
                    colormap=rr.components.Colormap.Viridis, depth_range=[0, 255], meter=1.0
                ),
                static=True,
            )
        else:
            recording.log(entity, rr.SegmentationImage.from_fields(opacity=1.0), static=True)
        recording.send_columns(
            entity,
            indexes=_times(steps, frames),
            columns=kind.columns(buffer=images.reshape(len(images), -1)),
        )


def _picture(values: NDArray[Any]) -> NDArray[np.uint8]:
    """Values (angle parts, velocity parts) as a picture: φ to the right, φ̇ upwards."""
    upwards = values.T[::-1].astype(np.uint8)
    return upwards.repeat(PIXELS[1], axis=0).repeat(PIXELS[0], axis=1)


def _events(
    recording: rr.RecordingStream, frames: Frames, trajectory: Trajectory, measures: Measures
) -> None:
    """Start, falls and first success, as lines of a log."""
    falls = np.flatnonzero(trajectory.reset)
    events = [(0, "INFO", "start"), (measures.steps - 1, "INFO", "end")]
    events += [
        (int(step), "WARN", f"fall {number + 1} of {len(falls)}, reset")
        for number, step in enumerate(falls[:LOGGED_FALLS])
    ]
    if measures.first_stable_step is not None:
        events.append((measures.first_stable_step, "INFO", "first stable window begins"))
    events.sort()
    recording.send_columns(
        "events",
        indexes=_times(np.array([step for step, _, _ in events]), frames),
        columns=rr.TextLog.columns(
            text=[text for _, _, text in events], level=[level for _, level, _ in events]
        ),
    )


def _about(recording: rr.RecordingStream, run: str, properties: Mapping[str, Any]) -> None:
    """The run in words."""
    rows = "\n".join(
        f"| {name.replace('_', ' ')} | {_brief(value)} |"
        for name, value in _known(properties).items()
        if name not in ("spec", "digest")
    )
    recording.log(
        "about",
        rr.TextDocument(f"**{run}**\n\n| | |\n| --- | --- |\n{rows}\n", media_type="text/markdown"),
        static=True,
    )


def _times(
    steps: Steps, frames: Frames, timelines: Iterable[str] = TIMELINES
) -> list[rr.TimeColumn]:
    """The same rows on every timeline; ``frame`` counts what is shown, without its gaps."""
    columns = {
        FRAME: lambda: rr.TimeColumn(FRAME, sequence=frames.at(steps)),
        STEP: lambda: rr.TimeColumn(STEP, sequence=steps),
        SIM_TIME: lambda: rr.TimeColumn(SIM_TIME, duration=steps * Pendulum().time_step),
    }
    return [columns[name]() for name in timelines]


def rounded(values: NDArray[Any]) -> Real:
    """Values to 11 binary digits, a relative error below 0.05 %: they compress better."""
    mantissa, exponent = np.frexp(values.astype(np.float64))
    return np.ldexp(np.round(mantissa * 2048) / 2048, exponent)


def _brief(value: Any) -> str:
    return f"{value:,.4g}" if isinstance(value, float) else str(value)


def _known(properties: Mapping[str, Any]) -> dict[str, Any]:
    """Without what is unknown: a recording has no empty property."""
    return {name: value for name, value in properties.items() if value is not None}
