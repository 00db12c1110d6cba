"""Trajectories as data frames, with the columns of the files and their units."""

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from upswing.physics.environment import Trajectory
from upswing.physics.pendulum import Pendulum
from upswing.runs.files.trajectory import SCHEMA, WINDOW_COUNTS
from upswing.study.measured import Windows

UNITS = {
    field.name: field.metadata[b"unit"].decode()
    for field in SCHEMA
    if b"unit" in (field.metadata or {})
}
"""The unit of each column of a trajectory that has one."""

UNITS_OF_WINDOWS = {
    "mean_reward": "rad²", "lowest_angle": "rad", "highest_angle": "rad", "highest_speed": "rad/s",
    "mean_td_error": "rad²",
}  # fmt: skip

UNITS_OF_SIMULATION = {
    "time": "s",
    **{name: unit for name, unit in UNITS.items() if name not in ("action", "td_error")},
    "acceleration": "m/s²",
}


def of_trajectory(trajectory: Trajectory, steps: NDArray[np.int64]) -> pd.DataFrame:
    """Those steps, shape (rows,), in the columns of the stored trajectory."""
    columns = {name: getattr(trajectory, name)[steps] for name in SCHEMA.names if name != "step"}
    return with_units(pd.DataFrame({"step": steps, **columns}), UNITS)


def of_windows(windows: Windows) -> pd.DataFrame:
    """The windows of a run, in the columns and kinds of the stored ones."""
    columns = {
        name: column.astype(np.int64 if name in WINDOW_COUNTS else np.float32)
        for name, column in windows._asdict().items()
    }
    return with_units(pd.DataFrame(columns), UNITS_OF_WINDOWS)


def of_simulation(trajectory: Trajectory, body: Pendulum) -> pd.DataFrame:
    """Every step of a policy that was followed with ``body``."""
    steps = np.arange(len(trajectory.angle))
    state = ("angle", "angular_velocity", "cart_position", "cart_velocity")
    frame = pd.DataFrame(
        {
            "step": steps,
            "time": steps * body.time_step,
            **{name: getattr(trajectory, name) for name in state},
            "acceleration": np.array(body.accelerations)[trajectory.action],
            "reward": trajectory.reward,
            "reset": trajectory.reset,
        }
    )
    return with_units(frame, UNITS_OF_SIMULATION)


def with_units(frame: pd.DataFrame, units: dict[str, Any]) -> pd.DataFrame:
    """The frame, with the units of its columns in ``attrs["units"]``."""
    frame.attrs["units"] = dict(units)
    return frame
