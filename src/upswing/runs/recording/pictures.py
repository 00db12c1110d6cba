"""The pictures of a recording: the pendulum, the phase plane, and maps of what was learned."""

from functools import cache
from math import ceil
from typing import Any

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from upswing.physics.environment import Trajectory
from upswing.physics.pendulum import Pendulum
from upswing.runs.recording.actions import UNDECIDED_COLOUR, action_colours, action_names
from upswing.runs.recording.axes import MODULES, SIDE, Grid, draw_axes, of_module
from upswing.runs.recording.frames import Frames, drawn_every, so_long, time_columns
from upswing.runs.recording.sizes import HALF_A_CART, marks_apart, unit_of
from upswing.runs.snapshots import Snapshots

TRAIL = 96
"""How long ago the oldest state is that the phase plane shows: half a second [steps of 5 ms]."""

TRAIL_POINTS = 8
"""Number of parts of the trail's line."""


def draw_pendulum(
    recording: rr.RecordingStream,
    frames: Frames,
    trajectory: Trajectory,
    body: Pendulum,
    track: float | None = None,
) -> None:
    """The pendulum on its cart, seen from the cart; the ground passes below.

    Args:
        recording: where it goes.
        frames: the rows of the recording.
        trajectory: what is drawn.
        body: how long the pendulum is, by which everything is scaled, and what the actions are.
        track: the cart goes no further than |x| = this [m]; None: for ever.
    """
    unit, apart = unit_of(body.length), marks_apart(body.length)
    shown = frames.drawn
    angle = trajectory.angle[shown].astype(np.float64)
    # The picture's y points down; with φ from upright a positive angle leans to the left.
    tip = -body.orientation * body.length * np.stack([np.sin(angle), np.cos(angle)], axis=1)
    rods = np.stack([np.zeros_like(tip), tip], axis=1).astype(np.float32)
    indexes = time_columns(shown, frames)
    recording.log(
        "pendulum/cart",
        rr.Boxes2D(
            half_sizes=[[HALF_A_CART * unit, 0.015 * unit]], centers=[[0, 0]], colors=[[90, 90, 90]]
        ),
        static=True,
    )
    each_side = ceil(round(4 * body.length / apart, 6))
    marks, top, bottom = np.arange(-each_side, each_side + 1) * apart, 0.03 * unit, 0.04 * unit
    recording.log(
        "pendulum/ground",
        rr.LineStrips2D([[[x, top], [x, bottom]] for x in marks], colors=[[120, 120, 120]]),
        static=True,
    )
    recording.log(
        "pendulum/rod",
        rr.LineStrips2D.from_fields(colors=[[0, 158, 115]], radii=[0.006 * unit]),
        static=True,
    )
    recording.send_columns(
        "pendulum/rod", indexes=indexes, columns=rr.LineStrips2D.columns(strips=list(rods))
    )
    ground = np.zeros((len(shown), 3), dtype=np.float32)
    ground[:, 0] = -(trajectory.cart_position[shown] % apart)
    recording.send_columns(
        "pendulum/ground", indexes=indexes, columns=rr.Transform3D.columns(translation=ground)
    )
    if track is not None:
        _draw_ends(recording, frames, trajectory, track, unit)
    push = np.zeros((len(shown), 2), dtype=np.float32)
    strongest = max(map(abs, body.accelerations))
    push[:, 0] = np.array(body.accelerations)[trajectory.action[shown]] * unit / (10 * strongest)
    recording.log(
        "pendulum/push",
        rr.Arrows2D.from_fields(
            colors=[[213, 94, 0]], radii=[0.004 * unit], origins=[[0, 0.022 * unit]]
        ),
        static=True,
    )
    recording.send_columns(
        "pendulum/push", indexes=indexes, columns=rr.Arrows2D.columns(vectors=push)
    )


def _draw_ends(
    recording: rr.RecordingStream, frames: Frames, trajectory: Trajectory, track: float, unit: float
) -> None:
    """A post at either end of the track, which the cart touches there."""
    at = track + HALF_A_CART * unit
    posts = [[[x, -0.06 * unit], [x, 0.04 * unit]] for x in (-at, at)]
    recording.log(
        "pendulum/track",
        rr.LineStrips2D(posts, colors=[[204, 121, 167]], radii=[0.005 * unit]),
        static=True,
    )
    shown = frames.drawn
    away = np.zeros((len(shown), 3), dtype=np.float32)
    away[:, 0] = -trajectory.cart_position[shown]
    recording.send_columns(
        "pendulum/track",
        indexes=time_columns(shown, frames),
        columns=rr.Transform3D.columns(translation=away),
    )


def draw_phase_plane(
    recording: rr.RecordingStream, frames: Frames, trajectory: Trajectory, learned: Snapshots
) -> None:
    """The state in the plane of φ and φ̇, over the map of the policy."""
    shown = frames.drawn
    grid, every = grid_of(learned), drawn_every(frames.time_step)
    width, height, limit = grid.width, grid.height, grid.angle_limit
    x = (np.clip(trajectory.angle[shown], -limit, limit) + limit) / (2 * limit) * width
    fastest = grid.velocity_limit
    velocity = np.clip(trajectory.angular_velocity[shown], -fastest, fastest)
    y = (fastest - velocity) / (2 * fastest) * height
    places = np.stack([x, y], axis=1).astype(np.float32)
    # A trail ends where the stretch began, the pendulum was reset, or φ came round.
    new = (np.diff(shown, prepend=shown[0]) > every) | (
        np.abs(np.diff(places[:, 0], prepend=places[0, 0])) > width / 4
    )
    begins = np.maximum.accumulate(np.where(new, np.arange(len(shown)), 0))
    length, part = trail(frames.time_step)
    trails = [
        places[max(begin, end - length) : end + 1 : part] if end > begin else places[[end, end]]
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
    indexes = time_columns(shown, frames)
    recording.send_columns(
        "phase/trail", indexes=indexes, columns=rr.LineStrips2D.columns(strips=trails)
    )
    recording.send_columns(
        "phase/state", indexes=indexes, columns=rr.Points2D.columns(positions=places)
    )


def trail(time_step: float) -> tuple[int, int]:
    """The length of the trail and of a part of its line, in drawings, for steps of ``time_step`` [s]."""
    drawings = max(1, so_long(TRAIL, time_step) // drawn_every(time_step))
    part = max(1, -(-drawings // TRAIL_POINTS))
    return drawings - drawings % part, part


def draw_learned(
    recording: rr.RecordingStream,
    frames: Frames,
    learned: Snapshots,
    body: Pendulum,
    unit: float = 1.0,
) -> None:
    """Value and greedy policy over the grid, as they grew, with axes and what their colours mean.

    Args:
        recording: where they go.
        frames: the rows of the recording.
        learned: what is shown; its values divided by ``unit`` are in rad².
        body: what the actions are.
        unit: of the values (R3), in rad².
    """
    best = learned.q.max(axis=-1)
    learned = _thinned(learned)
    grid, actions = grid_of(learned), len(body.accelerations)
    classes = _classes(grid.modules, body.accelerations)
    recording.log("learned", classes, static=True)
    recording.log("phase", classes, static=True)
    finite = np.nan_to_num(learned.q, nan=0.0, posinf=0.0, neginf=np.finfo(np.float64).min)
    equals = (finite == finite.max(axis=-1, keepdims=True)).sum(axis=-1)
    chosen = finite.argmax(axis=-1) + actions * learned.owner
    policy = np.where(equals > 1, undecided(actions), chosen)
    value = finite.max(axis=-1)
    lowest = min(float(best[np.isfinite(best)].min(initial=0)), -1e-9)
    shade = np.round(255 * (1 - np.clip(value, lowest, 0) / lowest))
    draw_axes(recording, grid, body.accelerations, lowest / unit)
    steps = np.minimum(learned.steps, frames.steps[-1])
    for entity, maps, kind in (
        ("learned/policy", policy, rr.SegmentationImage),
        ("learned/value", shade, rr.DepthImage),
    ):
        images = np.stack([_picture(one, *grid.pixels) for one in maps])
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
            indexes=time_columns(steps, frames),
            columns=kind.columns(buffer=images.reshape(len(images), -1)),
        )


def grid_of(learned: Snapshots) -> Grid:
    """Of what the maps of a run are pictures."""
    owner, modules = _thinned(learned).owner, int(learned.owner.max()) + 1
    return Grid(owner.shape, learned.angle_limit, learned.velocity_limit, modules)


def _thinned(learned: Snapshots) -> Snapshots:
    """Only every second part, or third …, where there are more than a map has pixels."""
    rows, columns = (
        slice((every := -(-parts // SIDE)) // 2, None, every) for parts in learned.owner.shape
    )
    return learned._replace(q=learned.q[:, rows, columns], owner=learned.owner[rows, columns])


def undecided(actions: int) -> int:
    """The class of a tile where several of the actions are equally good, as where nothing is known."""
    return len(MODULES) * actions


@cache
def _classes(modules: int, accelerations: tuple[float, ...]) -> rr.AnnotationContext:
    """What the classes of the policy's map are called and how they are coloured."""
    names, colours = action_names(accelerations), action_colours(accelerations)
    actions = len(accelerations)
    classes = [
        rr.AnnotationInfo(
            id=module * actions + action,
            label=f"{MODULES[module]}: {names[action]}" if modules > 1 else names[action],
            color=of_module(colours[action], module),
        )
        for module in range(modules)
        for action in range(actions)
    ]
    classes.append(
        rr.AnnotationInfo(id=undecided(actions), label="undecided", color=UNDECIDED_COLOUR)
    )
    return rr.AnnotationContext(classes)


def _picture(values: NDArray[Any], width: int, height: int) -> NDArray[np.uint8]:
    """Values (angle parts, velocity parts), each so wide and high: φ to the right, φ̇ upwards."""
    upwards = values.T[::-1].astype(np.uint8)
    return upwards.repeat(height, axis=0).repeat(width, axis=1)
