"""What a task says of its pendulum: sane values only, and one clear line for each that is not."""

import pytest

from upswing.study.config import pendulum_of_bound, validated
from upswing.study.errors import BadInput

STUDY = {
    "seeds": 2,
    "architectures": {
        "table": {"learner": "table"},
        "idle": {"learner": "control", "behaviour": "idle"},
        "two": {"learner": "table", "modular": True},
    },
}


def study(architecture="table", **task):
    tasks = {"mine": {"kind": "full-control", "steps": 1_000, **task}}
    alphas = {} if architecture == "idle" else {"alphas": [0.1]}
    experiments = [{"tasks": ["mine"], "architectures": [architecture], **alphas}]
    return validated({"mine.yaml": {**STUDY, "tasks": tasks, "experiments": experiments}})


@pytest.mark.parametrize(
    ("architecture", "task", "said"),
    [
        ("table", {"pendulum": {"length": 0}}, "tasks.mine.pendulum.length: 0: "),
        (
            "table",
            {"pendulum": {"lenght": 1}},
            "tasks.mine.pendulum.lenght: unknown key: did you mean 'length'?",
        ),
        ("table", {"pendulum": {"time_step": 1}}, "tasks.mine.pendulum.time_step: 1: "),
        (
            "table",
            {"pendulum": {"mass": "1 kg"}},
            'tasks.mine.pendulum.mass: "1 kg": must be a number',
        ),
        ("table", {"pendulum": {"accelerations": [1]}}, "tasks.mine.pendulum.accelerations"),
        ("table", {"pendulum": {"accelerations": [10, 0, -10]}}, "ascending"),
        ("table", {"pendulum": {"accelerations": [0, 10]}}, "one must be negative"),
        ("table", {"pendulum": {"friction": 1}}, "friction: 1 N·m·s is too much"),
        ("table", {"track": {"limit": -1}}, "tasks.mine.track.limit: -1: "),
        ("table", {"track": {"at_end": "bounces"}}, 'tasks.mine.track.at_end: "bounces": must be '),
        ("table", {"start": {"middle": 270}}, "tasks.mine.start.middle: 270: "),
        ("table", {"tiles": {"velocity_parts": 0}}, "tasks.mine.tiles.velocity_parts: 0: "),
        ("idle", {"pendulum": {"accelerations": [-20, 20]}}, "needs an action of 0 m/s²"),
        ("two", {"tiles": {"angle_parts": 10}}, "a multiple of 4"),
    ],
)
def test_what_is_not_sane_is_one_line(architecture, task, said):
    with pytest.raises(BadInput) as error:
        study(architecture, **task)
    (line,) = error.value.problems
    assert line.startswith("mine.yaml: ")
    assert said in line


def test_the_bound_is_of_the_first_task_of_full_control():
    assert pendulum_of_bound(study(pendulum={"length": 0.4})).length == 0.4
    assert pendulum_of_bound(study()).length == 0.2
