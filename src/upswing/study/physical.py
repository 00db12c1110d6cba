"""The pendulum, the track, the starts and the tiles of a task; the defaults are the thesis's."""

from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from upswing.study.values import Strict, listed

Number = Annotated[float, Field(allow_inf_nan=False)]

THESIS_TIME_STEP = 0.005
"""dt of §4.2.2 [s]; what the project counts in steps, it counts in steps of this length."""


class PendulumOptions(Strict):
    """The constants of §4.2.2 and the accelerations of §4.4."""

    mass: Annotated[Number, Field(ge=1e-4, le=1e3)] = Field(
        default=0.1, description="m of the rod [kg] (§4.2.2)."
    )
    length: Annotated[Number, Field(ge=0.01, le=100)] = Field(
        default=0.2, description="l of the rod [m] (§4.2.2)."
    )
    gravity: Annotated[Number, Field(ge=0.1, le=100)] = Field(
        default=9.81, description="g [m/s²] (§4.2.2)."
    )
    friction: Annotated[Number, Field(ge=0, le=1e3)] = Field(
        default=0.001, description="f_c, viscous, at the joint [N·m·s] (eq. 17)."
    )
    time_step: Annotated[Number, Field(ge=1e-5, le=0.1)] = Field(
        default=THESIS_TIME_STEP, description="dt of eq. 22 to 25 [s]; a step of learning."
    )
    accelerations: Annotated[
        tuple[Annotated[Number, Field(ge=-1e4, le=1e4)], ...],
        BeforeValidator(listed),
        Field(min_length=2, max_length=21),
    ] = Field(
        default=(-10.0, 0.0, 10.0),
        description="ẍ of each action [m/s²] (§4.4), ascending; at least one to either side.",
    )

    @model_validator(mode="after")
    def _is_sane(self) -> Self:
        if not all(a < b for a, b in pairwise(self.accelerations)):
            raise ValueError("accelerations: write them in ascending order, each once")
        if not self.accelerations[0] < 0 < self.accelerations[-1]:
            raise ValueError("accelerations: at least one must be negative and one positive")
        inertia = self.mass * self.length**2 / 3
        if self.friction * self.time_step >= inertia:
            most = inertia / self.time_step
            raise ValueError(
                f"friction: {self.friction:g} N·m·s is too much for this rod and step: below {most:.3g} "
                "or one step turns the velocity round (eq. 23)"
            )
        return self


class TrackOptions(Strict):
    """How far the cart can go, and what happens there; in the thesis the track has no end (§4.2)."""

    limit: Annotated[Number, Field(gt=0, le=1e6)] | None = Field(
        default=None, description="Largest |x| of the cart [m]; none: the track has no end."
    )
    at_end: Literal["stops", "falls"] = Field(
        default="stops",
        description="At the end of the track the cart stops dead, which jerks the rod, or the run is "
        "reset as after a fall.",
    )


class StartOptions(Strict):
    """Where a run starts, uniformly; what is not given is as the kind of task has it."""

    middle: Annotated[Number, Field(ge=-180, le=180)] | None = Field(
        default=None, description="The middle of the starts [°]: 0 upright, 180 hanging."
    )
    within: Annotated[Number, Field(ge=0, le=180)] | None = Field(
        default=None, description="A run starts within ± this of the middle [°]."
    )
    velocity: Annotated[Number, Field(ge=0, le=1e3)] | None = Field(
        default=None, description="… and turns with at most ± this [rad/s]; without it, reading R8."
    )


class TileOptions(Strict):
    """How φ and φ̇ are cut into tiles; what is not given is the thesis's (§4.5.1, §4.6.1)."""

    angle_parts: Annotated[int, Field(ge=2, le=720)] | None = Field(
        default=None, description="Number of parts of φ; a multiple of 4 with modules."
    )
    angle_limit: Annotated[Number, Field(gt=0, le=180)] | None = Field(
        default=None, description="The parts of φ cover ± this [°]; the edge parts reach further."
    )
    velocity_parts: Annotated[int, Field(ge=2, le=1000)] = Field(
        default=20, description="Number of parts of φ̇."
    )
    velocity_limit: Annotated[Number, Field(gt=0, le=1e4)] = Field(
        default=20.0, description="The parts of φ̇ cover ± this [rad/s] (R15)."
    )
