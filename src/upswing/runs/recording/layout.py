"""The views that a recording opens with, made for each task."""

import rerun as rr
import rerun.blueprint as rrb

from upswing.runs.recording.frames import FRAME
from upswing.study.task import Task

PENDULUM_SIZE = 0.26
"""Half the height of the picture of the pendulum [m]."""


def whole_run() -> rrb.TimeAxis:
    """A time axis that shows all there is; a viewer's own would show the neighbourhood of the cursor."""
    unlimited = rr.TimeRangeBoundary.infinite()
    return rrb.TimeAxis(view_range=rr.TimeRange(start=unlimited, end=unlimited))


HIDDEN_COLUMNS = ("digest", "dirty", "git_commit", "spec", "task", "seconds", "steps_per_second")


def table_layout(task: Task) -> rrb.TableBlueprint:
    """The catalog's table of the runs of a task: what a run is, then what came of it."""
    measures = task.first_measures
    first = ("architecture", "alpha", "seed", *measures, "first_stable_step")
    rest = ("mean_reward", "steps")
    columns = [rrb.table.Column("recording link", name="recording")]
    columns += [
        rrb.table.Column(f"property:run:{name}", name=name.replace("_", " "))
        for name in (*first, *rest)
    ]
    hidden = [f"property:run:{name}" for name in HIDDEN_COLUMNS]
    hidden += [f"property:RecordingInfo:{name}" for name in ("name", "start_time")]
    columns += [rrb.table.Column(name, visible=False) for name in hidden]
    best_first = rrb.table.SortBy(
        f"property:run:{measures[0]}",
        direction="ascending" if task.judged_by == "falls" else "descending",
    )
    return rrb.TableBlueprint(
        table_layout=rrb.table.TableLayout(columns=columns), sort_by=best_first
    )


def run_layout(task: Task) -> rrb.Blueprint:
    """The layout of a run of a task, for a laptop's screen."""
    limit = task.angle_limit

    def lines(
        name: str, *origins: str, axis: tuple[float, float] | None = None
    ) -> rrb.TimeSeriesView:
        return rrb.TimeSeriesView(
            name=name,
            origin=origins[0],
            contents=[f"{origin}/**" for origin in origins],
            axis_x=whole_run(),
            axis_y=rrb.ScalarAxis(range=axis) if axis else None,
            plot_legend=rrb.PlotLegend(visible=True, corner=rrb.Corner2D.RightTop),
        )

    pictures = rrb.Vertical(
        rrb.Spatial2DView(
            name="Pendulum",
            origin="/pendulum",
            visual_bounds=rrb.VisualBounds2D(
                x_range=(-0.4, 0.4), y_range=(-PENDULUM_SIZE, PENDULUM_SIZE)
            ),
        ),
        rrb.Horizontal(
            rrb.Spatial2DView(
                name="Phase plane, policy",
                origin="/phase",
                contents=["/phase/**", "/learned/policy"],
            ),
            rrb.Spatial2DView(name="Value", origin="/learned", contents=["/learned/value"]),
        ),
        row_shares=[2, 3],
    )
    curves = rrb.Vertical(
        lines("Angle [°]", "/angle", "/envelope/angle", axis=(-1.1 * limit, 1.1 * limit)),
        lines("Angular velocity [rad/s]", "/angular_velocity"),
        lines("Action: cart acceleration [m/s²]", "/action", axis=(-11, 11)),
        lines("Learning: reward and TD error [rad²]", "/learning"),
        row_shares=[3, 2, 1.5, 2],
    )
    words = rrb.Vertical(
        rrb.TextDocumentView(name="Run", origin="/about"),
        rrb.TextLogView(name="Events", origin="/events"),
        lines("Cart position [m]", "/cart/position"),
        lines("Cart velocity [m/s]", "/cart/velocity"),
        row_shares=[3, 2, 1.2, 1.2],
    )
    return rrb.Blueprint(
        rrb.Horizontal(pictures, curves, words, column_shares=[4, 5, 2.5]),
        rrb.TimePanel(timeline=FRAME, state="collapsed", playback_speed=1.0, fps=100.0),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
    )
