"""A specification → its runs → their artefacts."""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from safetensors.numpy import save

from upswing import loop
from upswing.learners import Beginning, Learner, create
from upswing.measures import Measures, in_windows, measure
from upswing.pendulum import FROM_HANGING, FROM_UPRIGHT, Pendulum
from upswing.spec import Spec
from upswing.store.files import written
from upswing.store.provenance import metadata, provenance
from upswing.store.recording import write_recording
from upswing.store.trajectory import kept_steps, write_trajectory, write_windows
from upswing.tasks import KINDS, start
from upswing.tiles import tiles_for

REWARD_SCALES = {"half_turn": 4.0, "radians": 1.0, "degrees": (180 / np.pi) ** 2}
"""From rad² into the unit of R3; half_turn reads 90° as π, so an angle is twice its radians."""

RESETS = {
    "fallen": loop.RESET_FALLEN,
    "terminal": loop.RESET_TERMINAL,
    "reset": loop.RESET_START,
}
HAND_OVERS = {"owner": loop.OWNER, "own": loop.OWN, "terminal": loop.TERMINAL}


class RunsFailed(RuntimeError):
    """Some runs of a job failed; the others are there."""


@dataclass
class Run:
    """A run that was learned."""

    trajectory: loop.Trajectory
    learner: Learner
    seconds: float  # spent learning


def train(spec: Spec, results: Path) -> None:
    """Learn every run of ``spec`` and store it below ``results``.

    A run that fails does not stop the others; ``RunsFailed`` then names it at the end.
    """
    failed = []
    trajectory = loop.empty_trajectory(spec.task.steps)
    for seed in spec.seeds:
        one = spec.of_seed(seed)
        print(f"{one.run(seed)}\n  to repeat it: {one.command(str(results))}", flush=True)
        try:
            run = learn(one, seed, trajectory)
            measures = _store(one, seed, run, results)
        except Exception as error:  # noqa: BLE001  whatever it is, the other runs go on
            failed.append(f"{one.run(seed)}: {type(error).__name__}: {error}")
            print(f"  failed: {failed[-1]}", file=sys.stderr, flush=True)
        else:
            rate = spec.task.steps / run.seconds
            print(f"  {run.seconds:.3f} s, {rate:,.0f} steps/s, {measures}", flush=True)
    if failed:
        raise RunsFailed("\n".join(failed))


def learn(spec: Spec, seed: int, trajectory: loop.Trajectory) -> Run:
    """One run from its beginning, recorded in ``trajectory``, which has room for its steps."""
    learner, advance = prepare(spec, seed, trajectory)
    advance(0, 0)  # compiles, or fetches what was compiled
    begin = perf_counter()
    advance(0, spec.task.steps)
    seconds = perf_counter() - begin
    if spec.alpha is None:
        trajectory.td_error.fill(np.nan)  # a control has values, but learns nothing
    return Run(trajectory, learner, seconds)


def prepare(
    spec: Spec, seed: int, trajectory: loop.Trajectory
) -> tuple[Learner, Callable[[int, int], None]]:
    """A fresh learner, and a function that lets it learn from one step up to another.

    All random numbers come from the seed alone, in three streams: actions, starts, first weights.
    So runs of different cells with the same seed see the same draws.
    """
    readings, settings = spec.readings, spec.architecture
    actions, starts, weights = (
        np.random.default_rng(stream) for stream in np.random.SeedSequence(seed).spawn(3)
    )
    body = Pendulum(
        orientation=FROM_UPRIGHT if readings.zero_of_angle == "upright" else FROM_HANGING
    )
    task = KINDS[spec.task.kind](readings)
    tiles = tiles_for(spec.task.kind, settings.modular, readings)
    scale = REWARD_SCALES[readings.reward_unit]
    learner = create(
        settings.learner,
        Beginning(
            tiles=tiles,
            hidden=settings.hidden,
            behaviour=settings.behaviour or "",
            readings=readings,
            lowest_q=-scale * task.largest_angle**2 / (1 - spec.discount),
            weights=weights,
        ),
    )
    printed_error = settings.learner == "networks" and readings.error_sign == "printed"
    rule = loop.Rule(
        step_size=0.0 if spec.alpha is None else float(spec.alpha),
        discount=float(spec.discount),
        bootstrap_sign=-1.0 if printed_error else 1.0,
        reward_scale=scale,
        epsilon=float(spec.epsilon) if learner.epsilon is None else learner.epsilon,
        random_ties=readings.ties == "random",
        reset=RESETS[readings.reset],
        hand_over=HAND_OVERS[readings.hand_over],
    )
    open_ = loop.nothing_open(tiles.modules)
    state = loop.State(*start(task, starts), 0.0, 0.0)

    def advance(first: int, last: int) -> None:
        nonlocal state
        state = loop.learn(
            body, task, tiles, learner.stepped, rule, state, open_, actions, starts,
            trajectory, first, last,
        )  # fmt: skip

    return learner, advance


def _store(spec: Spec, seed: int, run: Run, results: Path) -> Measures:
    """Write the four files of a run; returns its measures."""
    measures = measure(run.trajectory, spec.task.kind)
    place = results / "runs" / spec.run(seed)
    content = {"spec": spec.canonical(), "run": spec.run(seed)}
    outcome: dict[str, Any] = {
        **measures._asdict(),
        "seconds": run.seconds,
        "steps_per_second": measures.steps / run.seconds,
    }
    write_trajectory(
        place.with_name(f"{place.name}.trajectory.parquet"),
        run.trajectory,
        kept_steps(run.trajectory, measures.first_stable_step),
        metadata(**content),
    )
    write_recording(
        place.with_name(f"{place.name}.rrd"),
        spec.run(seed),
        run.trajectory,
        measures.first_stable_step,
        _properties(spec, seed, outcome),
    )
    with written(place.with_name(f"{place.name}.weights.safetensors")) as beside:
        learned = {name: np.ascontiguousarray(a) for name, a in run.learner.learned.items()}
        beside.write_bytes(save(learned, metadata={"spec": spec.canonical()}))
    write_windows(
        place.with_name(f"{place.name}.windows.parquet"),
        in_windows(run.trajectory),
        metadata(**content, outcome=outcome),
    )
    return measures


def _properties(spec: Spec, seed: int, outcome: dict[str, Any]) -> dict[str, Any]:
    """What the catalog of recordings can be sorted and filtered by."""
    made = provenance()
    return {
        "task": spec.task.name,
        "architecture": spec.architecture.name,
        "alpha": spec.alpha,
        "seed": seed,
        **outcome,
        "git_commit": made.git_commit,
        "dirty": made.dirty,
        "spec": spec.canonical(),
    }
