"""What a run came to: its measures, its greedy evaluation and its digest, as one row, for every job."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from upswing.physics.braking import stoppable_speeds
from upswing.physics.environment import Trajectory
from upswing.runs.evaluation import evaluate
from upswing.runs.files.trajectory import digest, kept_steps
from upswing.runs.metrics import in_windows, measure
from upswing.runs.simulation import Setting
from upswing.study.measured import Measures, Windows
from upswing.study.spec import Spec


class Outcome(NamedTuple):
    """A run, measured."""

    measures: Measures
    windows: Windows
    kept: NDArray[np.int64]  # the steps of the trajectory that are stored
    row: dict[str, Any]  # measures, evaluation and digest by name: columns of the table of runs


def outcome_of(spec: Spec, seed: int, setting: Setting, trajectory: Trajectory) -> Outcome:
    """Measure a run of ``spec`` that ``setting`` has learned and ``trajectory`` holds."""
    too_fast = stoppable_speeds(setting.body)
    measures = measure(trajectory, spec.task.judged_by == "falls", too_fast, setting.body.time_step)
    if measures.diverged_at is None and not _is_finite(setting):
        # An overflow that no later step met.
        measures = measures._replace(diverged_at=spec.task.steps - 1)
    windows = in_windows(trajectory, too_fast)
    kept = kept_steps(trajectory, measures.first_stable_step)
    row = {
        **measures._asdict(),
        **evaluate(setting, spec, seed)._asdict(),
        "digest": digest(trajectory, kept, windows),
    }
    return Outcome(measures, windows, kept, row)


def _is_finite(setting: Setting) -> bool:
    """Whether everything that was learned is a number."""
    return all(bool(np.isfinite(values).all()) for values in setting.learner.learned.values())
