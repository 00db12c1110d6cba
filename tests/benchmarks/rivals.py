"""The programs that upswing's loop is held against: C, a numpy loop, eager torch. Each does the same work."""

import shutil
import subprocess
import time
from functools import cache
from itertools import pairwise
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

import numpy as np
import torch

from upswing.physics.environment import empty_trajectory
from upswing.runs.simulation import prepare
from upswing.study.architecture import architecture_named
from upswing.study.spec import Spec
from upswing.study.task import task_named

HIDDEN: dict[str, tuple[int, ...]] = {
    "table": (),
    "networks-5": (5,),
    "networks-30": (30,),
    "networks-20-5": (20, 5),
}
ANGLES, VELOCITIES = 8, 20
ACCELERATIONS = np.array([-10.0, 0.0, 10.0])


def specification(learner: str, steps: int, modular: bool = False) -> Spec:
    """Full control as in the thesis: a table with α = 0.001, networks with α = 1."""
    from upswing.study.readings import Readings

    hidden = HIDDEN[learner]
    kind = "networks" if hidden else "table"
    return Spec(
        task=task_named("full-control", kind="full-control", steps=steps),
        architecture=architecture_named(learner, learner=kind, hidden=hidden, modular=modular),
        alpha=1.0 if hidden else 0.001,
        seeds=(0,),
        epsilon=0.01,
        discount=0.7,
        readings=Readings(),
    )


def ours(learner: str, steps: int, seed: int, modular: bool = False) -> float:
    """Nanoseconds a step of the compiled loop, recording every step."""
    spec = specification(learner, steps, modular)
    trajectory = empty_trajectory(steps)
    setting = prepare(spec, seed)
    setting.advance(trajectory, 0, 0)
    begin = time.perf_counter()
    setting.advance(trajectory, 0, steps)
    return (time.perf_counter() - begin) / steps * 1e9


FLAGS = ([], ["-mprefer-vector-width=128"], ["-fno-tree-vectorize"])
"""Beside -O3 -march=native. On short layers the compiler's own choice of vectors can be the slowest by far,
so the fastest of these builds is taken."""


@cache
def compiled_c(learner: str, real: str) -> Path | None:
    """The C program for a learner, compiled for this processor; None where there is no compiler."""
    if not shutil.which("gcc"):
        return None
    first, second = (*HIDDEN[learner], 0, 0)[:2]
    folder = Path(mkdtemp(prefix="upswing-bench-"))
    source = str(Path(__file__).with_name("learner.c"))
    builds = []
    for number, flags in enumerate(FLAGS):
        program = folder / f"{learner}-{real}-{number}"
        macros = [f"-DREAL={real}", f"-DFIRST={first}", f"-DSECOND={second}"]
        command = [
            "gcc",
            "-O3",
            "-march=native",
            *flags,
            *macros,
            source,
            "-o",
            str(program),
            "-lm",
        ]
        subprocess.run(command, check=True)
        builds.append((min(_timed(program, learner, 200_000, seed) for seed in range(3)), program))
    return min(builds)[1]


def _timed(program: Path, learner: str, steps: int, seed: int) -> float:
    alpha = "1" if HIDDEN[learner] else "0.001"
    done = subprocess.run(
        [program, str(steps), str(seed), alpha], capture_output=True, text=True, check=True
    )
    return float(done.stdout.split()[0])


def in_c(learner: str, steps: int, seed: int, real: str) -> float | None:
    """Nanoseconds a step of the C program."""
    program = compiled_c(learner, real)
    return None if program is None else _timed(program, learner, steps, seed)


def locate(angle: float, velocity: float) -> int:
    """The tile of a state."""
    row = int(np.clip(np.floor((angle + np.pi) / (2 * np.pi) * ANGLES), 0, ANGLES - 1))
    column = int(np.clip(np.floor((velocity + 20) / 40 * VELOCITIES), 0, VELOCITIES - 1))
    return row * VELOCITIES + column


def drive(steps: int, seed: int, values: Any, update: Any) -> float:
    """Nanoseconds a step of a loop in Python around ``values(tile)`` and ``update(tile, action, td)``."""
    random = np.random.default_rng(seed)
    state = np.array([random.uniform(-np.pi, np.pi), 0.0, 0.0, 0.0])
    record = np.zeros((steps, 7))
    tile = locate(state[0], state[1])
    begin = time.perf_counter()
    for t in range(steps):
        q = values(tile)
        if random.random() < 0.01:
            action = int(random.integers(3))
        else:
            best = np.flatnonzero(q == q.max())
            action = int(best[0] if len(best) == 1 else random.choice(best))
        x = ACCELERATIONS[action]
        angle, velocity, position, cart = state
        torque = 0.0981 * np.sin(angle) + 0.01 * x * np.cos(angle) - 0.001 * velocity
        acceleration = torque / (0.1 * 0.04 / 3)
        turned = angle + velocity * 0.005 + acceleration * 0.005**2
        turned -= 2 * np.pi * np.floor((turned + np.pi) / (2 * np.pi))
        following = np.array(
            [turned, velocity + acceleration * 0.005, position + cart * 0.005 + x * 0.005**2,
             cart + x * 0.005]
        )  # fmt: skip
        reward = -(turned**2)
        next_tile = locate(following[0], following[1])
        td_error = 4 * reward + 0.7 * values(next_tile).max() - q[action]
        update(tile, action, td_error)
        record[t] = (*state, reward, td_error / 4, action)
        state, tile = following, next_tile
    return (time.perf_counter() - begin) / steps * 1e9


def in_numpy(steps: int, seed: int) -> float:
    """Nanoseconds a step of a table in numpy."""
    q = np.zeros((ANGLES * VELOCITIES, 3))

    def update(tile: int, action: int, td_error: float) -> None:
        q[tile, action] += 0.001 * td_error

    return drive(steps, seed, q.__getitem__, update)


def in_torch(learner: str, steps: int, seed: int) -> float:
    """Nanoseconds a step of three networks in eager torch: autograd and SGD on one sample."""
    torch.manual_seed(seed)
    torch.set_num_threads(1)
    sizes = (ANGLES * VELOCITIES, *HIDDEN[learner], 1)
    networks = []
    for _ in range(3):
        layers: list[torch.nn.Module] = []
        for before, after in pairwise(sizes):
            layers += [torch.nn.Linear(before, after, bias=False), torch.nn.Sigmoid()]
        networks.append(torch.nn.Sequential(*layers[:-1]))
    optimisers = [torch.optim.SGD(network.parameters(), lr=0.1) for network in networks]
    inputs = torch.eye(ANGLES * VELOCITIES)

    def values(tile: int) -> Any:
        with torch.no_grad():
            return np.array([float(network(inputs[tile])) for network in networks])

    def update(tile: int, action: int, td_error: float) -> None:
        output = networks[action](inputs[tile])
        target = output.detach() + td_error
        optimisers[action].zero_grad()
        (0.5 * (output - target) ** 2).sum().backward()
        optimisers[action].step()

    return drive(steps, seed, values, update)
