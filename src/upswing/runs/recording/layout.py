"""The views that a recording opens with, made for each task."""

import rerun as rr
import rerun.blueprint as rrb

from upswing.runs.recording.axes import ABOVE, LEFT, SIDE, below
from upswing.runs.recording.frames import FRAME, real_time
from upswing.runs.recording.labels import LABELS, OTHER_ENDINGS, label
from upswing.runs.recording.sizes import view_of
from upswing.study.task import Task


def whole_run() -> rrb.TimeAxis:
    """A time axis that shows all there is; a viewer's own would show the neighbourhood of the cursor."""
    unlimited = rr.TimeRangeBoundary.infinite()
    return rrb.TimeAxis(view_range=rr.TimeRange(start=unlimited, end=unlimited))


HIDDEN = (
    "digest", "dirty", "git_commit", "spec", "task", "seconds", "steps_per_second", "falls_first_5000",
    "falls_2500_to_5000", "falls_after_stable", *OTHER_ENDINGS,
)  # fmt: skip
"""Columns of the catalog's table that are shown where they are asked for."""


def table_layout(task: Task) -> rrb.TableBlueprint:
    """The catalog's table of the runs of a task: what a run is, then what came of it, with units."""
    measures = task.first_measures
    first = ("architecture", "alpha", "seed", *measures, "first_stable_step")
    names = dict.fromkeys((*first, *(name for name in LABELS if name not in HIDDEN)))
    columns = [rrb.table.Column("recording link", name="recording")]
    columns += [
        rrb.table.Column(
            f"property:run:{name}",
            name=label(name, task),
            # The viewer puts every other kind of text into quotation marks.
            column_type=rr.components.EntityPath if name == "architecture" else None,
        )
        for name in names
    ]
    columns += [
        rrb.table.Column(f"property:run:{name}", name=label(name, task), visible=False)
        for name in dict.fromkeys(HIDDEN)
        if name not in names
    ]
    columns += [
        rrb.table.Column(f"property:RecordingInfo:{name}", visible=False)
        for name in ("name", "start_time")
    ]
    best_first = rrb.table.SortBy(
        f"property:run:{measures[0]}",
        direction="ascending" if task.judged_by == "falls" else "descending",
    )
    return rrb.TableBlueprint(
        table_layout=rrb.table.TableLayout(columns=columns), sort_by=best_first
    )


def run_layout(task: Task) -> rrb.Blueprint:
    """The layout of a run of a task, for a laptop's screen."""
    limit, pendulum, track = task.angle_limit, task.pendulum, task.track.limit
    across, up = view_of(pendulum.length)
    weakest, strongest = pendulum.accelerations[0], pendulum.accelerations[-1]

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

    around_a_map = rrb.VisualBounds2D(
        x_range=(-LEFT, SIDE + LEFT / 2),
        y_range=(-ABOVE, SIDE + below(len(pendulum.accelerations))),
    )
    pictures = rrb.Vertical(
        rrb.Spatial2DView(
            name="Pendulum",
            origin="/pendulum",
            visual_bounds=rrb.VisualBounds2D(x_range=(-across, across), y_range=(-up, up)),
        ),
        rrb.Horizontal(
            rrb.Spatial2DView(
                name="Policy, and the state",
                origin="/phase",
                contents=["/phase/**", "/learned/policy"],
                visual_bounds=around_a_map,
            ),
            rrb.Spatial2DView(
                name="Value",
                origin="/learned",
                contents=["/learned/**", "- /learned/policy"],
                visual_bounds=around_a_map,
            ),
        ),
        row_shares=[2, 3],
    )
    curves = rrb.Vertical(
        rrb.StateTimelineView(
            name="Which stretch of the run", origin="/stretch", time_view=whole_run()
        ),
        lines("Angle [°]", "/angle", "/envelope/angle", axis=(-1.1 * limit, 1.1 * limit)),
        lines("Angular velocity [rad/s]", "/angular_velocity"),
        lines("Action: cart acceleration [m/s²]", "/action", axis=(1.1 * weakest, 1.1 * strongest)),
        lines("Learning: reward and TD error [rad²]", "/learning"),
        row_shares=[1, 3, 2, 1.5, 2],
    )
    words = rrb.Vertical(
        rrb.TextDocumentView(name="What this is", origin="/about"),
        rrb.TextLogView(
            name="Events",
            origin="/events",
            columns=rrb.TextLogColumns(
                timeline_columns=[FRAME], text_log_columns=["loglevel", "body"]
            ),
        ),
        lines(
            "Cart position [m]",
            "/cart/position",
            axis=None if track is None else (-1.1 * track, 1.1 * track),
        ),
        lines("Cart velocity [m/s]", "/cart/velocity"),
        row_shares=[4, 2.5, 1, 1],
    )
    return rrb.Blueprint(
        rrb.Horizontal(pictures, curves, words, column_shares=[4, 4.5, 3.5]),
        rrb.TimePanel(
            timeline=FRAME,
            state="collapsed",
            playback_speed=1.0,
            fps=real_time(pendulum.time_step),
        ),
        rrb.SelectionPanel(state="hidden"),
        rrb.BlueprintPanel(state="hidden"),
    )
