"""What a learner would do without exploring: a greedy evaluation from a fixed grid of starts."""

from dataclasses import replace

import numpy as np

from upswing.physics.environment import State, empty_trajectory
from upswing.physics.tasks.episodes import JUDGED, STARTS, STEPS
from upswing.runs.metrics import UPRIGHT
from upswing.runs.simulation import Setting, new_method, streams
from upswing.runs.success import SUCCESS
from upswing.study.measured import Greedy
from upswing.study.spec import Spec


def evaluate(setting: Setting, spec: Spec, seed: int) -> Greedy:
    """Follow the policy that was learned, with ε = 0 and α = 0, from every start of the grid.

    What was learned stays as it is. A control keeps its own ε: being random is what it does.
    """
    kind = spec.task.kind
    *_, stream = streams(seed)
    epsilon = 0.0 if setting.learner.epsilon is None else setting.learner.epsilon
    rule = setting.rule._replace(step_size=0.0, epsilon=epsilon)
    steps, successes, upright = STEPS.get(kind, STEPS["full-control"]), 0, 0.0
    trajectory = empty_trajectory(steps)
    angles = STARTS.get(kind, STARTS["full-control"])
    for angle in angles:
        episode = replace(
            setting,
            rule=rule,
            state=State(float(angle), 0.0, 0.0, 0.0),
            method=new_method(spec, setting.coding),
            actions=stream,
            starts=stream,
        )
        episode.advance(trajectory, 0, steps)
        first = 0 if kind == "balancing" else steps - JUDGED
        # |φ| ≤ 20° on any turn (R4 `unbounded`) is a large cosine.
        share = float(np.mean(np.cos(trajectory.angle[first:]) >= np.cos(UPRIGHT)))
        upright += share
        successes += not trajectory.reset.any() if kind == "balancing" else share >= SUCCESS
    return Greedy(successes / len(angles), upright / len(angles))
