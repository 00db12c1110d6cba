"""A specification → its runs → their artefacts."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from typing import Any

from safetensors.numpy import save

from upswing.physics.environment import Trajectory, empty_trajectory
from upswing.runs.endings import endings
from upswing.runs.files.atomic import written
from upswing.runs.files.checksums import checksum
from upswing.runs.files.ledger import ledger_of_run, ledger_path, seal
from upswing.runs.files.provenance import metadata, provenance
from upswing.runs.files.resume import keep, take_back
from upswing.runs.files.trajectory import write_trajectory, write_windows
from upswing.runs.outcome import outcome_of
from upswing.runs.recording.write import write_recording
from upswing.runs.simulation import Setting, prepare
from upswing.runs.snapshots import Snapshots, look, moments, snapshots
from upswing.study.code import training
from upswing.study.ids import RUN_FILES, file_of
from upswing.study.measured import Measures
from upswing.study.spec import Spec


class RunsFailed(RuntimeError):
    """Some runs of a job failed; the others are there."""


@dataclass
class Run:
    """A run that was learned."""

    trajectory: Trajectory
    setting: Setting
    learned: Snapshots  # what it knew on the way
    seconds: float  # spent learning


def train(spec: Spec, results: Path) -> None:
    """Learn every run of ``spec`` and store it below ``results``.

    A run that fails does not stop the others; ``RunsFailed`` then names it at the end.
    """
    failed, finished = [], []
    trajectory = empty_trajectory(spec.task.steps)
    for seed in spec.seeds:
        one = spec.of_seed(seed)
        print(f"{one.run(seed)}\n  to repeat it: {one.command(str(results))}", flush=True)
        files = _files(one, results)
        if take_back(results, one.run(seed), _identity(one), files["rrd"].parent):
            print("  was finished before, when another run of its job failed", flush=True)
            _seal(one, results)
            finished.append(one)
            continue
        try:
            run = learn(one, seed, trajectory)
            with _all_or_none(*files.values(), ledger_path(results, ledger_of_run(one.run(seed)))):
                measures = _store(one, seed, run, results)
                _seal(one, results)
        except Exception as error:  # noqa: BLE001  whatever it is, the other runs go on
            failed.append(f"{one.run(seed)}: {type(error).__name__}: {error}")
            print(f"  failed: {failed[-1]}", file=sys.stderr, flush=True)
        else:
            finished.append(one)
            rate = spec.task.steps / run.seconds
            print(f"  {run.seconds:.3f} s, {rate:,.0f} steps/s, {measures}", flush=True)
    if failed:
        for one in finished:
            whole = list(_files(one, results).values())
            keep(results, one.run(one.seeds[0]), _identity(one), whole)
        raise RunsFailed("\n".join(failed))


def _files(one: Spec, results: Path) -> dict[str, Path]:
    """The files of a single run, by their endings."""
    return {kind: results / file_of(one.run(one.seeds[0]), kind) for kind in RUN_FILES}


@contextmanager
def _all_or_none(*files: Path) -> Iterator[None]:
    """The files of a run belong together: if one cannot be written, all of them go, old or new."""
    try:
        yield
    except BaseException:
        for path in files:
            path.unlink(missing_ok=True)
        raise


def _identity(one: Spec) -> str:
    """What a finished run must be of to be used again: its specification and the code that trains it."""
    return f"{training(one.architecture, one.task.kind).fingerprint} {one.canonical()}"


def _seal(one: Spec, results: Path) -> None:
    """Keep the checksums of a run's files, and what they are of, where neither can change the other."""
    name, files = ledger_of_run(one.run(one.seeds[0])), _files(one, results).values()
    code = training(one.architecture, one.task.kind).fingerprint
    seal(results, name, files, spec=one.canonical(), code=code)


def learn(spec: Spec, seed: int, trajectory: Trajectory) -> Run:
    """One run from its beginning, recorded in ``trajectory``, which has room for its steps."""
    setting = prepare(spec, seed)
    setting.advance(trajectory, 0, 0)  # compiles, or fetches what was compiled
    seconds, looked = 0.0, [(0, look(setting.learner, setting.encoder))]
    for first, last in pairwise(moments(spec.task.steps).tolist()):
        begin = perf_counter()
        setting.advance(trajectory, first, last)
        seconds += perf_counter() - begin
        looked.append((last, look(setting.learner, setting.encoder)))
    return Run(trajectory, setting, snapshots(setting.encoder, looked), seconds)


def _store(spec: Spec, seed: int, run: Run, results: Path) -> Measures:
    """Write the four files of a run; returns its measures."""
    measures, windows, kept, row = outcome_of(spec, seed, run.setting, run.trajectory)
    learned = {name: values.copy() for name, values in run.setting.learner.learned.items()}
    files = _files(spec, results)
    content: dict[str, Any] = {
        "spec": spec.canonical(),
        "run": spec.run(seed),
        "code": training(spec.architecture, spec.task.kind).fingerprint,
    }
    outcome: dict[str, Any] = {
        **row,
        **endings(windows),
        "seconds": run.seconds,
        "steps_per_second": measures.steps / run.seconds,
    }
    write_trajectory(
        files["trajectory.parquet"],
        run.trajectory,
        kept,
        metadata(**content),
    )
    write_recording(
        files["rrd"],
        spec.run(seed),
        run.trajectory,
        windows,
        measures,
        run.learned,
        run.setting.body,
        _properties(spec, seed, outcome),
    )
    with written(files["weights.safetensors"]) as beside:
        beside.write_bytes(save(learned, metadata={"spec": spec.canonical()}))
    # The windows come last: with them a run is complete, and they know the other files.
    content["checksums"] = {
        kind: checksum(files[kind]) for kind in ("trajectory.parquet", "rrd", "weights.safetensors")
    }
    write_windows(
        files["windows.parquet"],
        windows,
        metadata(**content, outcome=outcome),
    )
    return measures


def _properties(spec: Spec, seed: int, outcome: dict[str, Any]) -> dict[str, Any]:
    """What the catalog of recordings can be sorted and filtered by."""
    made = provenance()
    return {
        **{name: value for name, value in spec.columns(seed).items() if name != "run"},
        **outcome,
        "git_commit": made.git_commit,
        "dirty": made.dirty,
        "spec": spec.canonical(),
    }
