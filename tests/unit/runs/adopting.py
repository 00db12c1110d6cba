"""A small study, a file of agents beside it, and what asks to adopt one."""

import shutil
from pathlib import Path

import pytest

from upswing.analysis.aggregate import write_tables
from upswing.runs.adopt import Asked, adopt
from upswing.runs.adopted import joined
from upswing.runs.study_file import canonical, write_study
from upswing.runs.train import train
from upswing.study.config import validated
from upswing.study.matrix import Matrix

STUDY = {
    "seeds": [3, 4],
    "tasks": {
        "balancing": {"kind": "balancing", "steps": 3_000},
        "full-control": {"kind": "full-control", "steps": 3_000},
        "five": {
            "kind": "full-control", "steps": 3_000, "tiles": {"velocity_limit": 30},
            "pendulum": {"length": 0.4, "accelerations": [-20, -10, 0, 10, 20], "time_step": 0.01},
            "track": {"limit": 2.0}, "start": {"middle": 90, "within": 45},
        },
    },
    "architectures": {
        "table": {"learner": "table"},
        "push": {"learner": "control", "behaviour": "push"},
    },
    "experiments": [
        {"tasks": ["balancing"], "architectures": ["table"], "alphas": [1]},
        {"tasks": ["balancing", "full-control", "five"], "architectures": ["push"]},
    ],
}  # fmt: skip

AGENTS = '''
"""Agents of several kinds."""
import numpy as np
from pathlib import Path

(Path(__file__).parent / "was-run").touch()


def push(observation):
    return 2


def hard(observation):
    return 4


def grade(observation):
    """The harder, the further it leans."""
    cosine, sine, velocity = observation
    return int(np.clip(round(2 - 2 * (sine + 0.1 * velocity)), 0, 4))


def lean(observation):
    cosine, sine, velocity = observation
    return np.int64(0 if sine + 0.1 * velocity > 0 else 2)


class Hold:
    """It holds an action for four steps, and says what it was told."""

    def __init__(self, seed):
        self.seed, self.begun, self.action, self.left = seed, [], 0, 0

    def reset(self):
        self.begun.append(0)
        self.left = 0

    def __call__(self, observation):
        self.begun[-1] += 1
        if self.left == 0:
            self.action, self.left = lean(observation), 4
        self.left -= 1
        return np.array([self.action])


MADE = []


def hold(seed):
    MADE.append(Hold(seed))
    return MADE[-1]


def factory():
    return push


def two(observation, state):
    return 0


def late(observation):
    late.asked += 1
    if late.asked > 20_000:
        raise KeyError("lost")
    return 1


late.asked = 0
nothing = lambda observation: None
four = lambda observation: 3
sixth = lambda observation: 5
half = lambda observation: 0.5
truth = lambda observation: True
several = lambda observation: np.array([1, 2])
broken = lambda observation: 1 / 0
fruitless = lambda seed: 5
number = 7
'''


@pytest.fixture(scope="module", name="studied")
def small_study(tmp_path_factory):
    """A small study with its tables."""
    folder = tmp_path_factory.mktemp("studied") / "results"
    study = validated({"study": STUDY})
    write_study(canonical(study), folder)
    for spec in Matrix(study).cells.values():
        train(spec, folder)
    write_tables(folder, Matrix(study))
    return folder


@pytest.fixture(name="results")
def copied_results(studied, tmp_path, monkeypatch):
    """A copy of it, and beside it a file of agents."""
    shutil.copytree(studied, tmp_path / "results")
    (tmp_path / "agents.py").write_text(AGENTS, "utf-8")
    monkeypatch.chdir(tmp_path)
    return Path("results")


def asked(function, task="balancing", name="mine", seeds=(3,), reads=()):
    return Asked(f"agents.py:{function}", task, name, tuple(seeds), reads)


def adopted(results, *given, **more):
    spec = adopt(results, asked(*given, **more))
    write_tables(results, joined(results))
    return spec
