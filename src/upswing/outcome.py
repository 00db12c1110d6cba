"""What a run came to: its measures, its greedy evaluation and its digest, as one row, for every job."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.catching import highest_stoppable_speed
from upswing.environment import Trajectory
from upswing.evaluation import evaluate
from upswing.measured import Measures
from upswing.measures import Windows, in_windows, measure
from upswing.setting import Setting
from upswing.spec import Spec
from upswing.store.trajectory import digest, kept_steps


class Outcome(NamedTuple):
    """A run, measured."""

    measures: Measures
    windows: Windows
    kept: NDArray[np.int64]  # the steps of the trajectory that are stored
    row: dict[str, Any]  # measures, evaluation and digest by name: columns of the table of runs


def outcome_of(spec: Spec, seed: int, setting: Setting, trajectory: Trajectory) -> Outcome:
    """Measure a run of ``spec`` that ``setting`` has learned and ``trajectory`` holds."""
    measures = measure(trajectory, spec.task.kind, highest_stoppable_speed(setting.body))
    windows = in_windows(trajectory)
    kept = kept_steps(trajectory, measures.first_stable_step)
    row = {
        **measures._asdict(),
        **evaluate(setting, spec, seed)._asdict(),
        "digest": digest(trajectory, kept, windows),
    }
    return Outcome(measures, windows, kept, row)
