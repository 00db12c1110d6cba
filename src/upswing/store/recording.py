"""A run as a Rerun recording: what moved, what was done, what was learned, on two timelines."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from numpy.typing import NDArray

from upswing.loop import Trajectory
from upswing.pendulum import Pendulum
from upswing.store.files import written
from upswing.tasks import ACCELERATIONS

WHOLE_AT_START, WHOLE_AT_END = 1_000, 1_000
WHOLE_AROUND_SUCCESS = 500
THINNED = 1_000
"""Steps that a recording holds: whole at the start, the end and around the first success [steps]."""

SERIES = {
    "state": ("angle [rad]", "angular velocity [rad/s]"),
    "cart": ("position [m]", "velocity [m/s]"),
    "action": ("cart acceleration [m/s²]",),
    "learning": ("reward [rad²]", "TD error [rad²]"),
}
"""Entities and the names of their lines."""

Real = NDArray[np.float64]


def write_recording(
    path: Path,
    run: str,
    trajectory: Trajectory,
    first_stable_step: int | None,
    properties: Mapping[str, Any],
) -> None:
    """Write the recording of ``run`` with its parameters and measures as properties."""
    rr.set_strict_mode(True)  # otherwise errors become warnings and data is dropped
    task, recording_id = run.split("/")[0], run.replace("/", "_").replace(".", "-")
    with written(path) as beside:
        recording = rr.RecordingStream(f"upswing-{task}", recording_id=recording_id)
        recording.save(beside, default_blueprint=layout())
        rr.send_recording_name(run, recording=recording)
        recording.send_property("run", rr.AnyValues(**_known(properties)))
        for entity, names in SERIES.items():
            recording.log(entity, rr.SeriesLines(names=names), static=True)
        steps = recorded_steps(len(trajectory.angle), first_stable_step)
        for entity, values in _values(trajectory, steps).items():
            recording.send_columns(
                entity,
                indexes=[
                    rr.TimeColumn("step", sequence=steps),
                    rr.TimeColumn("sim_time", duration=steps * Pendulum().time_step),
                ],
                columns=rr.Scalars.columns(scalars=values.ravel()).partition(
                    [values.shape[1]] * len(steps)
                ),
            )
        recording.flush()
        recording.disconnect()


def recorded_steps(steps: int, first_stable_step: int | None) -> NDArray[np.int64]:
    """The steps in a recording, in order, shape (recorded,)."""
    chosen = np.zeros(steps, dtype=np.bool_)
    chosen[:: max(1, steps // THINNED)] = True
    chosen[:WHOLE_AT_START] = True
    chosen[-WHOLE_AT_END:] = True
    if first_stable_step is not None:
        begin = max(0, first_stable_step - WHOLE_AROUND_SUCCESS)
        chosen[begin : first_stable_step + WHOLE_AROUND_SUCCESS] = True
    return np.flatnonzero(chosen)


def layout() -> rrb.Blueprint:
    """The views a recording opens with: state, cart, action and learning over the whole run."""
    unlimited = rr.TimeRangeBoundary.infinite()
    whole_run = rrb.TimeAxis(view_range=rr.TimeRange(start=unlimited, end=unlimited))
    return rrb.Blueprint(
        rrb.Vertical(
            *(
                rrb.TimeSeriesView(
                    origin=entity,
                    name=entity.capitalize(),
                    axis_x=whole_run,
                    plot_legend=rrb.PlotLegend(visible=True),
                )
                for entity in SERIES
            )
        ),
        rrb.TimePanel(timeline="step", state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
    )


def _values(trajectory: Trajectory, steps: NDArray[np.int64]) -> dict[str, Real]:
    """What each entity shows at ``steps``, shape (recorded, lines)."""
    lines: dict[str, tuple[NDArray[Any], ...]] = {
        "state": (trajectory.angle, trajectory.angular_velocity),
        "cart": (trajectory.cart_position, trajectory.cart_velocity),
        "action": (np.array(ACCELERATIONS)[trajectory.action],),
        "learning": (trajectory.reward, trajectory.td_error),
    }
    return {
        entity: _rounded(np.stack([column[steps] for column in columns], axis=1))
        for entity, columns in lines.items()
    }


def _rounded(values: NDArray[Any]) -> Real:
    """Values with 12 bits after the point, a relative error below 0.02 %: they compress better."""
    mantissa, exponent = np.frexp(values.astype(np.float64))
    return np.ldexp(np.round(mantissa * 4096) / 4096, exponent)


def _known(properties: Mapping[str, Any]) -> dict[str, Any]:
    """Without what is unknown: a recording has no empty property."""
    return {name: value for name, value in properties.items() if value is not None}
