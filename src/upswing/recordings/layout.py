"""The views that a recording opens with, made once for each kind of task."""

import rerun as rr
import rerun.blueprint as rrb

FRAME, STEP, SIM_TIME = "frame", "step", "sim_time"
TIMELINES = (FRAME, STEP, SIM_TIME)
PENDULUM_SIZE = 0.26
"""Half the height of the picture of the pendulum [m]."""


def whole_run() -> rrb.TimeAxis:
    """A time axis that shows all there is; a viewer's own would show the neighbourhood of the cursor."""
    unlimited = rr.TimeRangeBoundary.infinite()
    return rrb.TimeAxis(view_range=rr.TimeRange(start=unlimited, end=unlimited))


def run_layout(kind: str) -> rrb.Blueprint:
    """The layout of a run of a ``kind`` of task, for a laptop's screen."""
    limit = 90 if kind == "balancing" else 180

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
                name="Phase plane on the policy",
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
