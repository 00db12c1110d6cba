"""What is met when balancing with random actions: episodes that end with a fall.

All actions are equally likely, whatever the state, as for an agent of the thesis before its first reward
(R6). Such a policy needs nothing that was learned, the returns of a state vary under it, and an episode
takes some dozens of steps.
"""

import numpy as np

from upswing.agents.features import locate
from upswing.agents.features.grid import Tiles
from upswing.agents.prediction import ENDED, Experience
from upswing.physics import tasks
from upswing.physics.environment import State, transition
from upswing.physics.jit import compiled
from upswing.physics.pendulum import Pendulum
from upswing.physics.tasks import Task


def met_at_random(body: Pendulum, task: Task, tiles: Tiles, steps: int, seed: int) -> Experience:
    """So many steps of ``task`` with random actions; the last episode may be cut short."""
    floats, wholes = (np.zeros((3, steps)), np.zeros((3, steps), np.int64))
    found = Experience(floats[0], floats[1], wholes[0], floats[2], wholes[1], wholes[2])
    actions, starts = (np.random.default_rng(of) for of in np.random.SeedSequence(seed).spawn(2))
    _meet(body, task, tiles, actions, starts, found)
    return found


@compiled
def _meet(
    body: Pendulum,
    task: Task,
    tiles: Tiles,
    actions: np.random.Generator,
    starts: np.random.Generator,
    found: Experience,
) -> None:
    angle, angular_velocity = tasks.start(task, starts)
    state, begun = State(angle, angular_velocity, 0.0, 0.0), 0
    for t in range(len(found.tile)):
        action = int(actions.random() * len(body.accelerations))
        taken = transition(body, task, 0.0, state, action, starts)
        found.angle[t], found.angular_velocity[t] = state.angle, state.angular_velocity
        found.tile[t] = locate(tiles, state.angle, state.angular_velocity).tiles[0]
        found.reward[t] = taken.reward
        found.begun[t] = begun
        if taken.fell:
            found.after[t] = ENDED
            begun = t + 1
        else:
            after = taken.after
            found.after[t] = locate(tiles, after.angle, after.angular_velocity).tiles[0]
        state = taken.after
