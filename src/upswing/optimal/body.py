"""The pendulum that dynamic programming is done for, and how far its grids reach."""

from math import hypot, sqrt

from upswing.optimal.state_grid import Grid
from upswing.physics.pendulum import Pendulum, body_of
from upswing.study.config import Study, pendulum_of_bound


def body_of_study(study: Study | None) -> Pendulum:
    """The pendulum of a study's first task of full control, or the thesis's."""
    return body_of(pendulum_of_bound(study)) if study else Pendulum()


def reaching(grid: Grid, body: Pendulum) -> Grid:
    """A grid that reaches as far for this pendulum as it does for the thesis's."""
    return grid._replace(limit=natural_speed(body) / natural_speed(Pendulum()) * grid.limit)


def natural_speed(body: Pendulum) -> float:
    """What velocities go with: √(√(g² + a²)/l) for the strongest push a [rad/s]."""
    push = max(map(abs, body.accelerations))
    return sqrt(hypot(body.gravity, push) / body.length)
