"""The pendulum that dynamic programming is done for."""

from upswing.physics.pendulum import Pendulum, body_of
from upswing.study.config import Study, pendulum_of_bound


def body_of_study(study: Study | None) -> Pendulum:
    """The pendulum of a study's first task of full control, or the thesis's."""
    return body_of(pendulum_of_bound(study)) if study else Pendulum()
