"""The pole of 1983 on its cart, as Barto, Sutton and Anderson have it but for friction, and their 162 boxes."""

from math import cos, radians, sin
from typing import Any

import numpy as np

from upswing.agents.algorithms import Step, learn_from
from upswing.agents.features import Place
from upswing.agents.learners import choose, values
from upswing.physics.jit import compiled

CART, POLE, HALF_LENGTH, GRAVITY, FORCE = 1.0, 0.1, 0.5, 9.8, 10.0  # [kg], [kg], [m], [m/s²], [N]
TIME_STEP = 0.02  # [s]
EDGE, LARGEST = 2.4, radians(12)  # where a trial ends [m], [rad]
BOXES = 3 * 3 * 6 * 3


@compiled
def cell(value: float, cuts: tuple[float, ...]) -> int:
    """How many of the cuts lie below a value."""
    found = 0
    for cut in cuts:
        if value >= cut:
            found += 1
    return found


@compiled
def box(x: float, speed: float, angle: float, turning: float) -> Place:
    """Three parts of the position, three of its speed, six of the angle, three of its speed."""
    one, six = radians(1), radians(6)
    fifty = radians(50)
    index = cell(x, (-0.8, 0.8))
    index = 3 * index + cell(speed, (-0.5, 0.5))
    index = 6 * index + cell(angle, (-six, -one, 0.0, one, six))
    return Place(0, (3 * index + cell(turning, (-fifty, fifty)),))


@compiled
def trials(
    learner: Any, algorithm: Any, rule: Any, draws: np.random.Generator, lengths: Any, enough: int
) -> int:
    """Fill ``lengths`` with those of the trials, each from the middle, until one is ``enough`` steps."""
    td_errors = np.nan
    number, length, t = 0, 0, 0
    x, speed, angle, turning = 0.0, 0.0, 0.0, 0.0
    while number < len(lengths) and length < enough:
        place = box(x, speed, angle, turning)
        q = values(learner, place)
        action = choose(learner, q, rule, draws.random())
        force = FORCE if action == 1 else -FORCE
        pull = (force + POLE * HALF_LENGTH * turning * turning * sin(angle)) / (CART + POLE)
        bend = HALF_LENGTH * (4.0 / 3.0 - POLE * cos(angle) ** 2 / (CART + POLE))
        twist = (GRAVITY * sin(angle) - cos(angle) * pull) / bend
        push = pull - POLE * HALF_LENGTH * twist * cos(angle) / (CART + POLE)
        x, speed = x + TIME_STEP * speed, speed + TIME_STEP * push
        angle, turning = angle + TIME_STEP * turning, turning + TIME_STEP * twist
        failed = abs(x) > EDGE or abs(angle) > LARGEST
        after = box(x, speed, angle, turning)
        step = Step(t, angle, turning, place, q, action, 0.0, after, failed, failed)
        learn_from(algorithm, 0, learner, rule, td_errors, step)
        t, length = t + 1, length + 1
        if failed:
            lengths[number] = length
            number, length = number + 1, 0
            x, speed, angle, turning = 0.0, 0.0, 0.0, 0.0
    return number
