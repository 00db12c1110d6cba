"""A fuzzy controller for balancing, which §4.1 calls the usual way: rules in words, weighed by degree.

It is a controller of Takagi and Sugeno (1985) of order zero: each rule answers with a number. That is
what Mamdani's controller (1975) comes to where a conclusion is a single number and not a set.
"""

from typing import NamedTuple

import numpy as np
from pydantic import Field

from upswing.agents.controller import ControllerLearner, nearness
from upswing.agents.features import Point
from upswing.agents.learners import Array, Beginning, values_of
from upswing.agents.policy import Q
from upswing.physics.jit import compiled, inlined
from upswing.study.controller import ControllerOptions
from upswing.study.values import Positive

TERMS = NL, NS, ZE, PS, PL = -1.0, -0.5, 0.0, 0.5, 1.0
"""Negative large, negative small, zero, positive small, positive large; 1 stands for `large`."""

RULES = (
    # φ̇ is NL, NS, ZE, PS, PL  and φ is
    (PL, PL, PL, PS, ZE),  # NL
    (PL, PL, PS, ZE, NS),  # NS
    (PL, PS, ZE, NS, NL),  # ZE
    (PS, ZE, NS, NL, NL),  # PS
    (ZE, NS, NL, NL, NL),  # PL
)
"""What the cart's acceleration shall be, of a pendulum whose φ is zero upright."""


class Options(ControllerOptions):
    """What its words mean."""

    angle_large: Positive = Field(
        default=10.0, description="The φ that is wholly large [°]; small is half of it."
    )
    velocity_large: Positive = Field(
        default=1.5, description="The φ̇ that is wholly large [rad/s]; small is half of it."
    )

    def in_words(self) -> str:
        """For a reader of the page."""
        return (
            "a fuzzy controller of 25 rules; an angle is large from "
            f"{self.angle_large:g}° on, an angular velocity from {self.velocity_large:g} rad/s"
        )


class Fuzzy(NamedTuple):
    """The rules, and where each term is wholly true."""

    rules: Array  # (terms of φ, terms of φ̇) [m/s²]
    angles: Array  # (terms,) [rad]
    velocities: Array  # (terms,) [rad/s]
    accelerations: tuple[float, ...]  # of the actions [m/s²]


@inlined
def degree(peaks: Array, term: int, x: float) -> float:
    """How true a term is of ``x``: 1 at its own peak, 0 at its neighbours' and straight between.

    Beyond the outermost peaks the outermost terms stay wholly true.
    """
    inside = min(max(x, peaks[0]), peaks[-1])
    if inside < peaks[term]:
        return float(max(0.0, 1.0 - (peaks[term] - inside) / (peaks[term] - peaks[term - 1])))
    if inside > peaks[term]:
        return float(max(0.0, 1.0 - (inside - peaks[term]) / (peaks[term + 1] - peaks[term])))
    return 1.0


@compiled
def surface(fuzzy: Fuzzy, angle: float, angular_velocity: float) -> float:
    """The acceleration that it wants [m/s²]: the rules' mean, weighed by how true each premise is."""
    total, weight = 0.0, 0.0
    for i in range(len(fuzzy.angles)):
        for j in range(len(fuzzy.velocities)):
            # “and” is the product
            truth = degree(fuzzy.angles, i, angle) * degree(fuzzy.velocities, j, angular_velocity)
            total += truth * fuzzy.rules[i, j]
            weight += truth
    return total / weight


@values_of(Fuzzy)
def _values(fuzzy: Fuzzy, point: Point) -> Q:
    return nearness(fuzzy.accelerations, surface(fuzzy, point.angle, point.angular_velocity))


def create(beginning: Beginning) -> ControllerLearner:
    """The rules above, with the task's largest acceleration for `large`."""
    body, options, terms = beginning.body, beginning.options, np.array(TERMS)
    # Where φ is zero hanging (R1), the same push turns the pendulum the other way.
    large = body.orientation * max(map(abs, body.accelerations))
    fuzzy = Fuzzy(
        rules=large * np.array(RULES),
        angles=np.radians(options["angle_large"]) * terms,
        velocities=options["velocity_large"] * terms,
        accelerations=tuple(body.accelerations),
    )
    arrays = {"rules": fuzzy.rules, "angles": fuzzy.angles, "velocities": fuzzy.velocities}
    return ControllerLearner(fuzzy, arrays)
