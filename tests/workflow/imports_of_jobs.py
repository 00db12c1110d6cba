"""Run every kind of job of a small study, each in a process of its own, and say what each imported.

A program of its own, so that no module of the project is there before a job begins: third-party
packages are imported once, then a process is forked for each job. Its only output is one JSON object,
from the name of a job to the modules of ``upswing`` that it imported.

    python -m tests.workflow.imports_of_jobs CONFIG READINGS CLAIMS TEMPLATES
"""

import json
import os
import sys
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path

import matplotlib.pyplot
import numba
import pandas
import pydantic
import rerun
import scipy.stats
import torch
import yaml

THIRD_PARTY = (matplotlib.pyplot, numba, pandas, pydantic, rerun, scipy.stats, torch, yaml)
Job = tuple[str, Callable[[], None]]


def imported_by(job: Callable[[], None]) -> list[str]:
    """What a job imports of ``upswing``, in a fork of this process; its output goes nowhere."""
    reading, writing = os.pipe()
    if (child := os.fork()) == 0:
        status = 1
        try:
            silence = os.open(os.devnull, os.O_WRONLY)
            os.dup2(silence, 1)
            # As plain Python: an index of what was compiled imports whatever was ever compiled.
            numba.config.DISABLE_JIT = True  # type: ignore[attr-defined]
            job()
            names = [name for name in sys.modules if name.split(".")[0] == "upswing"]
            with os.fdopen(writing, "w") as pipe:
                json.dump(sorted(names), pipe)
            status = 0
        except BaseException:  # noqa: BLE001  whatever it is, the parent says so
            traceback.print_exc()
        finally:
            os._exit(status)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        said = pipe.read()
    if os.waitpid(child, 0)[1]:
        raise SystemExit("a job failed")
    names: list[str] = json.loads(said)
    return names


def asked(config: Path, readings: Path, claims: Path) -> dict[str, object]:
    """What there is to run, told by a fork, as plain values."""
    reading, writing = os.pipe()
    if os.fork() == 0:
        from upswing.figures import drawable
        from upswing.recordings.comparison_names import comparison_names
        from upswing.runs.study_file import canonical
        from upswing.study.claims import load_claims
        from upswing.study.config import load
        from upswing.study.matrix import Matrix
        from upswing.study.sweeps import groups, load_sweeps

        study = load(config)
        matrix = Matrix(study)
        judged = load_claims(claims)
        sweeps = load_sweeps(readings, study)
        changes = any(experiment.title for experiment in study.experiments)
        with os.fdopen(writing, "w") as pipe:
            json.dump(
                {
                    "study": canonical(study),
                    "results": study.results,
                    "search": study.search is not None,
                    "tiles": "full-control-long/table/alpha-0.001" in matrix.cells,
                    "changes": changes,
                    "cells": {cell: spec.canonical() for cell, spec in matrix.cells.items()},
                    "figures": drawable(matrix.cells, changes),
                    "comparisons": comparison_names(judged, matrix.cells),
                    "sweeps": {
                        name: [(g.name, g.round) for g in groups(s, study)]
                        for name, s in sweeps.items()
                    },
                },
                pipe,
            )
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        told: dict[str, object] = json.load(pipe)
    os.wait()
    return told


def jobs(told: dict[str, object], readings: Path, claims: Path, templates: Path) -> Iterator[Job]:
    """Every job, in an order in which each finds what it needs."""
    results = str(told["results"])

    def subcommand(*words: str, compiled: bool = False) -> Callable[[], None]:
        def run() -> None:
            if compiled:  # into a folder of its own, for it would take minutes otherwise
                numba.config.DISABLE_JIT = False  # type: ignore[attr-defined]
                numba.config.CACHE_DIR = os.environ["NUMBA_CACHE_DIR"] = f"{results}/compiled"  # type: ignore[attr-defined]
            _make_small()
            from upswing.cli.main import main

            if code := main(words):
                raise SystemExit(f"{words} ended with {code}")

        return run

    yield "study", subcommand("study", str(told["study"]), "--results", results)
    for cell, spec in told["cells"].items():  # type: ignore[attr-defined]
        yield f"train {cell}", subcommand("train", spec, "--results", results)
    yield "tables", subcommand("tables", results)
    if told["tiles"]:
        yield "tiles", subcommand("tiles", results, compiled=True)
    yield "verdicts", subcommand("verdicts", results, "--claims", str(claims))
    yield "history", subcommand("history", "write", results)
    if told["changes"]:
        yield "bound", subcommand("bound", results, compiled=True)
        yield "settling", subcommand("settling", results, compiled=True)
        yield "prediction", subcommand("prediction", results, compiled=True)
        yield "changes", subcommand("changes", results)
    if told["search"]:
        yield "shortest", subcommand("shortest", str(told["study"]), "--results", results)
    for figure in told["figures"]:  # type: ignore[attr-defined]
        yield f"figure {figure}", subcommand("figure", figure, results)
    for comparison in told["comparisons"]:  # type: ignore[attr-defined]
        yield "comparison", subcommand("comparison", comparison, results, "--claims", str(claims))
    yield "viewer", subcommand("viewer", results, "--templates", str(templates))
    for name, groups in told["sweeps"].items():  # type: ignore[attr-defined]
        ready = 1
        for group, number in groups:
            if number > ready:
                ready = number
                words = ("--study", str(told["study"]), "--sweeps", str(readings))
                yield "finalists", subcommand("finalists", name, str(number), results, *words)
            yield (
                f"sweep {name}",
                subcommand(
                    "sweep",
                    name,
                    group,
                    results,
                    "--study",
                    str(told["study"]),
                    "--sweeps",
                    str(readings),
                ),
            )
    if told["sweeps"]:
        yield (
            "readings",
            subcommand("readings", results, "--sweeps", str(readings), "--claims", str(claims)),
        )
    yield "report", subcommand("report", results, "--templates", str(templates))


def _make_small() -> None:
    """Shorten what no configuration says: it is the modules that count here, not the results.

    Nothing is imported for it: a module is shortened while the job itself imports it.
    """
    from importlib.machinery import SourceFileLoader

    execute = SourceFileLoader.exec_module

    def exec_module(self: SourceFileLoader, module: object) -> None:
        execute(self, module)  # type: ignore[arg-type]
        for name, value in SMALL.get(module.__name__, {}).items():  # type: ignore[attr-defined]
            getattr(module, name)  # it must still be there
            setattr(module, name, value(module) if callable(value) else value)

    SourceFileLoader.exec_module = exec_module  # type: ignore[method-assign]


def _followed_briefly(declared: Callable[..., type]) -> Callable[..., type]:
    """What a part says of itself, but of a task that its policies are followed for a few steps."""

    def briefly(kind: str, *words: object) -> type:
        options = declared(kind, *words)
        if kind == "tasks":
            options.greedy_steps, options.greedy_judged = 200, 100  # type: ignore[attr-defined]
        return options

    return briefly


SMALL = {
    "upswing.study.declared": {"declared": lambda module: _followed_briefly(module.declared)},
    "upswing.optimal.settling": {"GRID": lambda module: module.Grid(36, 21)},
    "upswing.optimal.prediction": {
        "GRID": lambda module: module.Grid(72, 81),
        "MET": 3_000,
        "CHOOSING": range(1),
        "SHOWN": range(1, 2),
    },
    "upswing.optimal.bound": {"GRIDS": lambda module: (module.Grid(36, 21), module.Grid(72, 81))},
    "upswing.optimal.tile_rows": {
        "BUDGET": 1,
        "FURTHER": 1,
        "LEARNED": {"balancing": (0.001, 500), "full-control": (0.01, 500)},
    },
    "upswing.optimal.tile_policy": {"BALANCED": 500},
    "upswing.optimal.represented": {"BUDGET": 1, "STEPS": 500},
    "upswing.analysis.contraction": {"PROBLEMS": 3},
}


def main() -> None:
    """Run all jobs."""
    config, readings, claims, templates = (Path(word) for word in sys.argv[1:])
    told = asked(config, readings, claims)
    found: dict[str, set[str]] = {}
    for name, job in jobs(told, readings, claims, templates):
        found.setdefault(name, set()).update(imported_by(job))
    print(json.dumps({name: sorted(modules) for name, modules in found.items()}))


if __name__ == "__main__":
    main()
