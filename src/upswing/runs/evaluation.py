"""What a learner would do without exploring: a greedy evaluation from a fixed grid of starts."""

from dataclasses import replace

import numpy as np

from upswing.physics.environment import State, empty_trajectory
from upswing.runs.metrics import UPRIGHT
from upswing.runs.simulation import Setting, new_algorithm, streams
from upswing.runs.success import SUCCESS
from upswing.study.measured import Greedy
from upswing.study.spec import Spec


def evaluate(setting: Setting, spec: Spec, seed: int) -> Greedy:
    """Follow the policy that was learned, with ε = 0 and α = 0, from every start of the grid.

    What was learned stays as it is. A control keeps its own ε: being random is what it does.
    """
    task = spec.task
    *_, stream, decisions = streams(seed)
    epsilon = 0.0 if setting.learner.epsilon is None else setting.learner.epsilon
    rule = setting.rule._replace(step_size=0.0, epsilon=epsilon)
    successes, upright = 0, 0.0
    steps, judged = task.steps_of(task.greedy_steps), task.steps_of(task.greedy_judged)
    trajectory = empty_trajectory(steps)
    for angle in task.greedy_starts:
        episode = replace(
            setting,
            rule=rule,
            state=State(float(angle), 0.0, 0.0, 0.0),
            algorithm=new_algorithm(spec, setting.encoder, setting.learner, decisions),
            actions=stream,
            starts=stream,
        )
        episode.advance(trajectory, 0, steps)
        first = steps - judged
        # |φ| ≤ 20° on any turn (R4 `unbounded`) is a large cosine.
        share = float(np.mean(np.cos(trajectory.angle[first:]) >= np.cos(UPRIGHT)))
        upright += share
        fell = bool(trajectory.reset.any())
        successes += not fell if task.judged_by == "falls" else share >= SUCCESS
    of = len(task.greedy_starts)
    return Greedy(successes / of, upright / of)
