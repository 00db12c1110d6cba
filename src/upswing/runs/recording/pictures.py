"""The pictures of a recording: the pendulum, the phase plane, and maps of what was learned."""

from functools import cache
from typing import Any

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from upswing.agents.features.grid import VELOCITY_LIMIT
from upswing.physics.environment import Trajectory
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import ACCELERATIONS, ACTIONS
from upswing.runs.recording.axes import (
    ACTION_NAMES,
    MODULES,
    UNDECIDED_COLOUR,
    Grid,
    draw_axes,
    module_colour,
)
from upswing.runs.recording.frames import DRAWN_EVERY, Frames, time_columns
from upswing.runs.snapshots import Snapshots

TRAIL = 24
"""Number of drawings whose states the phase plane shows: half a second."""

UNDECIDED = len(MODULES) * ACTIONS
"""The class of a tile where several actions are equally good, as where nothing is known yet."""


def draw_pendulum(
    recording: rr.RecordingStream, frames: Frames, trajectory: Trajectory, body: Pendulum
) -> None:
    """The pendulum on its cart, seen from the cart; the ground passes below."""
    shown = frames.drawn
    angle = trajectory.angle[shown].astype(np.float64)
    # The picture's y points down; with φ from upright a positive angle leans to the left.
    tip = -body.orientation * body.length * np.stack([np.sin(angle), np.cos(angle)], axis=1)
    rods = np.stack([np.zeros_like(tip), tip], axis=1).astype(np.float32)
    indexes = time_columns(shown, frames)
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


def draw_phase_plane(
    recording: rr.RecordingStream, frames: Frames, trajectory: Trajectory, learned: Snapshots
) -> None:
    """The state in the plane of φ and φ̇, over the map of the policy."""
    shown = frames.drawn
    grid = grid_of(learned)
    width, height, limit = grid.width, grid.height, grid.angle_limit
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
    indexes = time_columns(shown, frames)
    recording.send_columns(
        "phase/trail", indexes=indexes, columns=rr.LineStrips2D.columns(strips=trails)
    )
    recording.send_columns(
        "phase/state", indexes=indexes, columns=rr.Points2D.columns(positions=places)
    )


def draw_learned(
    recording: rr.RecordingStream, frames: Frames, learned: Snapshots, unit: float = 1.0
) -> None:
    """Value and greedy policy over the grid, as they grew, with axes and what their colours mean.

    Args:
        recording: where they go.
        frames: the rows of the recording.
        learned: what is shown; its values divided by ``unit`` are in rad².
        unit: of the values (R3), in rad².
    """
    grid = grid_of(learned)
    recording.log("learned", _classes(grid.modules), static=True)
    recording.log("phase", _classes(grid.modules), static=True)
    finite = np.nan_to_num(learned.q, nan=0.0, posinf=0.0, neginf=np.finfo(np.float64).min)
    equals = (finite == finite.max(axis=-1, keepdims=True)).sum(axis=-1)
    policy = np.where(equals > 1, UNDECIDED, finite.argmax(axis=-1) + ACTIONS * learned.owner)
    value = finite.max(axis=-1)
    best = learned.q.max(axis=-1)
    lowest = min(float(best[np.isfinite(best)].min(initial=0)), -1e-9)
    shade = np.round(255 * (1 - np.clip(value, lowest, 0) / lowest))
    draw_axes(recording, grid, lowest / unit)
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
    return Grid(learned.owner.shape, learned.angle_limit, int(learned.owner.max()) + 1)


@cache
def _classes(modules: int) -> rr.AnnotationContext:
    """What the classes of the policy's map are called and how they are coloured."""
    classes = [
        rr.AnnotationInfo(
            id=module * ACTIONS + action,
            label=f"{MODULES[module]}: {name}" if modules > 1 else name,
            color=module_colour(module, action),
        )
        for module in range(modules)
        for action, name in enumerate(ACTION_NAMES)
    ]
    classes.append(rr.AnnotationInfo(id=UNDECIDED, label="undecided", color=UNDECIDED_COLOUR))
    return rr.AnnotationContext(classes)


def _picture(values: NDArray[Any], width: int, height: int) -> NDArray[np.uint8]:
    """Values (angle parts, velocity parts), each so wide and high: φ to the right, φ̇ upwards."""
    upwards = values.T[::-1].astype(np.uint8)
    return upwards.repeat(height, axis=0).repeat(width, axis=1)
