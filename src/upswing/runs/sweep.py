"""A group of readings → one row a run: its measures, and nothing else of it."""

import json
import time
from pathlib import Path
from typing import Any

from upswing.physics.environment import Trajectory, empty_trajectory
from upswing.runs.files.ledger import seal
from upswing.runs.files.tables import OF_A_RUN, write_table
from upswing.runs.files.typed_table import Columns
from upswing.runs.outcome import outcome_of
from upswing.runs.rows import framed
from upswing.runs.simulation import prepare
from upswing.study.config import Study
from upswing.study.errors import BadInput, near
from upswing.study.matrix import Matrix
from upswing.study.measured import Measures
from upswing.study.paths import finalists_of_sweep, group_of_sweep
from upswing.study.spec import Spec
from upswing.study.sweeps import Overrides, Sweep, canonical_of, groups, label, specs
from upswing.study.swept_from import ledger_of_group, swept_from

OF_A_SWEPT_RUN: Columns = {
    **OF_A_RUN, "sweep": "text", "readings": "text", "cell": "text", "task": "text",
    **dict.fromkeys(Measures._fields, "number"), "diverged_at": "whole?",
}  # fmt: skip


def path_of(results: Path, sweep: str, group: str) -> Path:
    """Where the rows of a group stand."""
    return results / group_of_sweep(sweep, group)


def write_group(
    results: Path, study: Study, name: str, sweep: Sweep, group: str, code: str
) -> Path:
    """Run a group of a sweep and write its table; returns the table's path.

    Args:
        results: the folder of results.
        study: whose cells are run.
        name: of the sweep.
        sweep: the sweep.
        group: the name of one of its groups.
        code: the fingerprint of the code that runs it, which is kept with it.

    Raises:
        BadInput: there is no such group, or nobody has said which readings go on to its round.
    """
    known = {one.name: one for one in groups(sweep, study)}
    if group not in known:
        raise BadInput([f"sweep {name}: {group}: no such group; {near(group, known)}"])
    chosen = known[group]
    rows: list[dict[str, Any]] = []
    for overrides in chosen.members or read_finalists(results, name, chosen.round):
        begin = time.perf_counter()
        before = len(rows)
        for spec in specs(sweep, study, overrides, chosen):
            trajectory = empty_trajectory(spec.task.steps)
            rows += [
                {
                    "sweep": name,
                    "readings": canonical_of(overrides),
                    **outcome(spec, seed, trajectory),
                }
                for seed in spec.seeds
            ]
        took = time.perf_counter() - begin
        print(f"{label(overrides)}: {len(rows) - before} runs in {took:.1f} s", flush=True)
    path = path_of(results, name, group)
    path.parent.mkdir(parents=True, exist_ok=True)
    write_table(path, framed(rows))
    made_from = swept_from(sweep, study, chosen, Matrix(study).cells, code)
    seal(results, ledger_of_group(name, group), [path], **made_from)
    return path


def read_finalists(results: Path, name: str, number: int) -> list[Overrides]:
    """The readings that go on to a round of a sweep; ``BadInput`` if nobody has said which."""
    path = results / finalists_of_sweep(name, number)
    try:
        found = json.loads(path.read_text("utf-8"))
        if found and all(isinstance(one, dict) for one in found):
            return list(found)
    except (OSError, ValueError):
        pass
    said = "says not which readings go on" if path.exists() else "missing"
    raise BadInput([f"{path}: {said}; `upswing finalists {name} {number} {results}` makes it"])


def outcome(spec: Spec, seed: int, trajectory: Trajectory) -> dict[str, Any]:
    """One row: what a run came to; ``trajectory`` has room for its steps and is written over."""
    setting = prepare(spec, seed)
    setting.advance(trajectory, 0, spec.task.steps)
    row = outcome_of(spec, seed, setting, trajectory).row
    return {"cell": spec.cell, **spec.columns(seed), **row, "recording": ""}
